// Tables of which the COR stands in the tests of the fit, written in other ways that mean the same.
import { readFileSync } from "node:fs";
import { join } from "node:path";

const MARKS = [",", ";", "\t"];

/// Names, lower case, and others that mean the same.
const SYNONYMS = [
  [/\bheight\b/i, ["h", "Height", "height above the floor"]],
  [/\btime\b/i, ["t", "Time", "elapsed time"]],
  [/\brebound\b/i, ["Rebound", "bounce height"]],
  [/\bdrop\b/i, ["Drop", "drop height"]],
  [/\btrial\b/i, ["Run", "Trial", "attempt"]],
];
const REMARKS = ["# measured by two of us", "# see the notebook, page 12", "# windows shut"];

/// The tables of text with their COR and how near it is to be, as `handed.rs` has them.
export function planted(folder) {
  const list = readFileSync(join(folder, "handed.rs"), "utf8").match(/const CORS[^;]*\[\n([^\]]*)\];/)[1];
  const rows = [...list.matchAll(/\("([^"]+\.(?:csv|txt|md))", ([\d.]+), ([\d.]+),/g)];
  return rows.map(([, name, truth, near]) => {
    const text = readFileSync(join(folder, "handed", name), "utf8");
    return { name, truth: Number(truth), near: Number(near), text };
  });
}

/// Remarks above a table, and its rows as cells, if one mark parts all of them alike.
function cells(text) {
  const lines = text.replace(/^\ufeff/, "").split(/\r?\n/).filter((line) => line.trim() !== "");
  const begin = lines.findIndex((line) => !line.startsWith("#"));
  const [head, body] = [lines.slice(0, begin), lines.slice(begin)];
  const parts = (line, mark) => (line.includes('"') ? 1 : line.split(mark).length);
  const mark = MARKS.find((one) => parts(body[0], one) > 1 && body.every((line) => parts(line, one) === parts(body[0], one)));
  return mark && { head, mark, rows: body.map((line) => line.split(mark)) };
}

const number = (cell) => (/^\s*-?\d+(\.\d+)?\s*$/.test(cell) ? Number(cell) : undefined);

/// Ways to write the same table; `whole(n)` is a number below n at random.
const WAYS = {
  columns({ rows }, whole) {
    const order = rows[0].map((_, n) => n);
    for (let n = order.length - 1; n > 0; n -= 1) {
      const k = whole(n + 1);
      [order[n], order[k]] = [order[k], order[n]];
    }
    return { rows: rows.map((row) => order.map((n) => row[n])) };
  },
  names({ rows: [names, ...rest] }, whole) {
    const another = (text, [word, others]) => text.replace(word, others[whole(others.length)]);
    return { rows: [names.map((name) => SYNONYMS.reduce(another, name.replaceAll("_", " "))), ...rest] };
  },
  separator({ rows }, whole) {
    const marks = MARKS.filter((mark) => !rows.flat().some((cell) => cell.includes(mark)));
    return { mark: marks[whole(marks.length)] ?? "\t" };
  },
  remark: ({ head }, whole) => ({ head: [...head, REMARKS[whole(REMARKS.length)]] }),
  /// Blank lines around a table; between rows they part trials.
  blank: ({ head }) => ({ head: ["", ...head, ""], tail: ["", ""] }),
  mean({ rows }) {
    const means = rows[0].map((_, n) => rows.slice(1).map((row) => number(row[n])));
    const word = means.findIndex((column) => column.some((value) => value === undefined));
    const sum = (column) => column.reduce((all, value) => all + value);
    const mean = (column) => (column.includes(undefined) ? "" : (sum(column) / column.length).toFixed(3));
    // A mean has a cell that says so.
    if (word < 0) return {};
    return { rows: [...rows, means.map((column, n) => (n === word ? "Mean" : mean(column)))] };
  },
};

/// The table written in another way that means the same, and in which; none if it has no cells.
export function kept({ text }, whole) {
  let table = cells(text);
  if (table === undefined) return undefined;
  const ways = Object.keys(WAYS).filter(() => whole(3) === 0);
  for (const way of ways) table = { ...table, ...WAYS[way](table, whole) };
  const { head, mark, rows, tail = [] } = table;
  return { ways, text: [...head, ...rows.map((row) => row.join(mark)), ...tail, ""].join("\n") };
}
