// A text file as a grid of cells. A cell that is edited is replaced in the text; all else stays as
// it is, byte for byte.

import { made, say } from "./elements.js";

/// How many rows are shown.
const SHOWN = 500;

/// The separator that parts most lines alike.
function separator(lines) {
  const counts = (mark) => lines.filter((line) => line.includes(mark)).length;
  return ["\t", ";", ","].reduce((best, mark) => (counts(mark) > counts(best) ? mark : best), "\t");
}

/// Where the cells of a line are: `[start, end]` each; a mark within quotes parts nothing.
function cells(line, mark) {
  const found = [];
  let start = 0;
  let quoted = false;
  for (let n = 0; n <= line.length; n += 1) {
    if (line[n] === '"') quoted = !quoted;
    if (n === line.length || (line[n] === mark && !quoted)) {
      found.push([start, n]);
      start = n + 1;
    }
  }
  return found;
}

const bare = (raw) => (/^\s*".*"\s*$/s.test(raw) ? raw.trim().slice(1, -1).replaceAll('""', '"') : raw);
const quoted = (text, mark) => (text.includes(mark) || text.includes('"') ? `"${text.replaceAll('"', '""')}"` : text);

/// The text of a file, if it is one.
export function textOf(bytes) {
  if (bytes.includes(0)) return undefined;
  try {
    return new TextDecoder("utf-8", { fatal: true, ignoreBOM: true }).decode(bytes);
  } catch {
    return undefined;
  }
}

/// Shows `text` in `element`; `changed` is called with the new text, and with whether its cells are
/// others than those that are shown.
export function grid(element, text, changed) {
  const ending = text.includes("\r\n") ? "\r\n" : "\n";
  const lines = text.split(/\r?\n/);
  if (lines.at(-1) === "") lines.pop();
  const mark = separator(lines);
  const width = Math.max(1, ...lines.slice(0, SHOWN).map((line) => cells(line, mark).length));
  const whole = () => lines.join(ending) + ending;

  function put(row, column, value) {
    while (lines.length <= row) lines.push("");
    const spans = cells(lines[row], mark);
    if (column < spans.length) {
      const [start, end] = spans[column];
      if (bare(lines[row].slice(start, end)) === value) return;
      lines[row] = lines[row].slice(0, start) + quoted(value, mark) + lines[row].slice(end);
    } else if (value !== "") {
      lines[row] += mark.repeat(column - spans.length + 1) + quoted(value, mark);
    }
  }
  function edit(row, column, value) {
    put(row, column, value);
    changed(whole(), false);
  }
  /// Rows of a spreadsheet go into the cells from this one on.
  function paste(event, row, column) {
    const block = event.clipboardData.getData("text/plain").replace(/\r?\n$/, "");
    if (!/[\t\n]/.test(block)) return;
    event.preventDefault();
    event.stopPropagation();
    block.split(/\r?\n/).forEach((line, down) => line.split("\t").forEach((value, across) => put(row + down, column + across, value)));
    changed(whole(), true);
  }

  const input = (row, column) => {
    const span = cells(lines[row], mark)[column];
    const value = span ? bare(lines[row].slice(...span)) : "";
    const cell = made("input", { value, size: Math.min(24, Math.max(6, value.length)), spellcheck: false, autocomplete: "off" });
    cell.setAttribute("aria-label", say("table.cell", { row: row + 1, column: column + 1 }));
    cell.dataset.place = `${row}:${column}`;
    cell.addEventListener("input", () => edit(row, column, cell.value));
    cell.addEventListener("paste", (event) => paste(event, row, column));
    return made("td", {}, cell);
  };
  const body = made("tbody");
  const append = (row) => {
    const number = made("th", { scope: "row", textContent: row + 1 });
    const line = lines[row];
    // A comment is one cell, however many marks it has.
    const one = line.startsWith("#");
    const data = one ? [made("td", { colSpan: width, textContent: line })] : Array.from({ length: width }, (_, n) => input(row, n));
    body.append(made("tr", {}, number, ...data));
  };
  for (let row = 0; row < Math.min(lines.length, SHOWN); row += 1) append(row);
  body.addEventListener("keydown", (event) => {
    const step = { ArrowUp: -1, ArrowDown: 1, Enter: 1 }[event.key];
    if (step === undefined || !event.target.dataset.place) return;
    const [row, column] = event.target.dataset.place.split(":").map(Number);
    const next = body.querySelector(`[data-place="${row + step}:${column}"]`);
    if (next) {
      event.preventDefault();
      next.focus();
      next.select();
    }
  });
  const table = made("table", {}, body);
  element.replaceChildren(table);
  // Cells before comments.
  element.scrollTop = body.querySelector("[data-place]")?.closest("tr").offsetTop ?? 0;
  if (lines.length > SHOWN) element.append(made("p", { textContent: say("table.long", { shown: SHOWN, rows: lines.length }) }));

  return {
    /// One more row, whose first cell takes the focus.
    add() {
      lines.push("");
      append(lines.length - 1);
      body.querySelector(`[data-place="${lines.length - 1}:0"]`)?.focus();
    },
    /// Marks the cell that a message is of, counted from 1: the line, and the character in it.
    mark(row, character) {
      for (const cell of body.querySelectorAll("[aria-invalid]")) cell.removeAttribute("aria-invalid");
      if (!row || !(row <= lines.length)) return;
      const column = cells(lines[row - 1], mark).findIndex(([, end]) => character - 1 <= end);
      body.querySelector(`[data-place="${row - 1}:${Math.max(0, column)}"]`)?.setAttribute("aria-invalid", "true");
    },
  };
}
