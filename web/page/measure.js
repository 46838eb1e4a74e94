// Measure: files in, the COR out.

import { EXAMPLE } from "./parts.js";
import { ask } from "./engine.js";
import { at, draw, made, problem, save, say, tell } from "./elements.js";
import { grid, textOf } from "./grid.js";
import { record } from "./record.js";
import { heard } from "./sound.js";

/// The largest files that are taken, together, in MB: more takes longer than anyone waits.
const MOST = 64;
/// How long a hand rests before edited cells are fitted, ms.
const REST = 150;
const OPTIONS = [
  "height_unit", "time_unit", "drop", "sigma_height", "sigma_time", "sigma_zero", "gravity", "ball", "drag",
  "column", "sheet", "header", "group", "filter", "fps", "scale", "zero", "direction", "listen",
];
const EMPTY = "bounce\theight_cm\n0\t\n1\t\n2\t\n3\t\n";

/// The last fit: `{ report, points, scene, … }`; what `fitted` is called with.
let last;
let files = [];
let shown;
let asked = 0;
let timer;

/// Who wants to know of every fit.
export const listeners = [];

function options() {
  return Object.fromEntries(OPTIONS.map((name) => [name, at(`option-${name}`).value]));
}

async function fit() {
  const mine = (asked += 1);
  at("result").setAttribute("aria-busy", "true");
  const names = files.map(({ name, bytes }) => [name, bytes.length]);
  try {
    const answer = await ask({ ask: "fit", files: names, options: options() }, files.map(({ bytes }) => bytes));
    if (mine === asked) show({ ...answer, json: answer.report, report: JSON.parse(answer.report) });
  } catch (error) {
    if (mine === asked) fail(error);
  }
}

function show(answer) {
  last = answer;
  const { report } = answer;
  at("result").setAttribute("aria-busy", "false");
  const verdict = say(`verdict.${report.verdict}`);
  at("verdict").textContent = verdict;
  at("verdict").className = report.verdict;
  const cor = (value) => (value ? say("headline", { value }) : undefined);
  at("headline").textContent = cor(answer.headline) ?? "";
  at("reason").textContent = report.reason.charAt(0).toUpperCase() + report.reason.slice(1) + ".";
  const group = ({ name, verdict: of, headline, reason }) =>
    made("li", { textContent: say("group", { name, verdict: say(`verdict.${of}`), headline: cor(headline) ?? reason }) });
  at("groups").replaceChildren(...answer.groups.map(group));
  problem(at("problem"));
  draw(at("fit-pictures"), answer.pictures);
  at("fit-saves").hidden = false;
  at("save-svg").disabled = !motionOf(answer);
  at("save-wav").hidden = recording() === undefined;
  at("play-fit").disabled = answer.scene === null;
  at("compare-fit").disabled = !report.motions?.length;
  at("report").hidden = false;
  at("text").textContent = answer.text;
  shown?.mark();
  tell(say("fit.done", { name: report.table, verdict, headline: cor(answer.headline) ?? "" }));
  for (const listener of listeners) listener(answer);
}

const motionOf = ({ pictures }) => pictures.find(([kind]) => kind === "motion")?.[1];

/// The only file, if it is a sound.
const recording = () => (files.length === 1 && sounds(files[0]) ? files[0] : undefined);
const sounds = ({ name }) => /\.wav$/i.test(name);

function fail(error) {
  last = undefined;
  at("result").setAttribute("aria-busy", "false");
  at("verdict").textContent = say("verdict.none");
  at("verdict").className = "refused";
  for (const id of ["headline", "reason"]) at(id).textContent = "";
  at("groups").replaceChildren();
  const named = error.option && { message: say("failed.option", { option: say(`option.${error.option}`), message: error.message }) };
  problem(at("problem"), named || error);
  draw(at("fit-pictures"), []);
  at("fit-saves").hidden = true;
  at("report").hidden = true;
  shown?.mark(error.line, error.column);
  tell(at("problem").textContent.split("\n")[0]);
  for (const listener of listeners) listener(undefined);
}

/// Shows the cells of the only file, and takes their changes.
function table() {
  shown = undefined;
  const [file, ...others] = files;
  const text = others.length === 0 ? textOf(file.bytes) : undefined;
  at("table-title").textContent = say("table.of", { name: files.map(({ name }) => name).join(", ") });
  at("add-row").hidden = text === undefined;
  if (text === undefined) {
    const part = (one) => {
      const content = textOf(one.bytes);
      if (content !== undefined) return made("pre", { textContent: content.slice(0, 4000) });
      return made("p", { textContent: say(sounds(one) ? "table.sound" : "table.binary", one) });
    };
    at("grid").replaceChildren(...files.map(part));
    return;
  }
  shown = grid(at("grid"), text, (changed, others) => {
    file.bytes = new TextEncoder().encode(changed);
    if (others) table();
    clearTimeout(timer);
    timer = setTimeout(fit, REST);
  });
}

/// Says that `size` bytes are more than are taken, if they are.
function large(size) {
  const megabytes = size / 1e6;
  if (megabytes <= MOST) return false;
  asked += 1;
  fail({ message: say("failed.large", { size: Math.ceil(megabytes), most: MOST }) });
  return true;
}

/// Shows files in place of those that there are, and fits them.
function put(list) {
  files = list;
  table();
  return fit();
}

/// Fits what was dropped, pasted or chosen.
export async function take(list) {
  if (list.length === 0 || large(list.reduce((sum, file) => sum + file.size, 0))) return;
  const read = async (file) => heard({ name: file.name, bytes: new Uint8Array(await file.arrayBuffer()) });
  let found;
  try {
    found = await Promise.all(list.map(read));
  } catch {
    // What is dropped may be a folder, or be gone.
    asked += 1;
    fail({ message: say("failed.unread", { name: list.map(({ name }) => name).join(", ") }) });
    return;
  }
  await put(found);
}

/// Text that is at hand is shown at once: what is typed or pasted next goes into its cells.
async function of(name, text) {
  const bytes = new TextEncoder().encode(text);
  if (!large(bytes.length)) await put([{ name, bytes }]);
}

function csv() {
  if (files.length === 1 && textOf(files[0].bytes) !== undefined) return textOf(files[0].bytes);
  const quote = (text) => `"${String(text).replaceAll('"', '""')}"`;
  const rows = last.points.map(({ trial, label, time, height }) => [trial, quote(label), time, height].join(","));
  return ["trial,reading,time_s,height_m", ...rows, ""].join("\n");
}

export function measure(play, compare) {
  const field = (name) => {
    const input = made("input", { id: `option-${name}`, type: "text", autocomplete: "off", spellcheck: false });
    input.addEventListener("change", fit);
    return made("label", {}, say(`option.${name}`), " ", input);
  };
  at("option-fields").append(...OPTIONS.map(field));
  const stem = () => files[0].name.replace(/\.[^.]*$/, "") || "table";
  const on = (id, act) => at(id).addEventListener("click", act);
  at("files").addEventListener("change", (event) => take([...event.target.files]).then(() => { event.target.value = ""; }));
  on("example", () => of("squash-on-cement.csv", EXAMPLE));
  on("blank", () => of("table.tsv", EMPTY));
  on("add-row", () => shown?.add());
  on("save-json", () => save(`${stem()}.json`, last.json, "application/json"));
  on("save-csv", () => save(`${stem()}.csv`, csv(), "text/csv"));
  on("save-svg", () => save(`${stem()}.svg`, motionOf(last), "image/svg+xml"));
  on("save-wav", () => save(`${stem()}.wav`, recording().bytes, "audio/wav"));
  record(take);
  on("play-fit", () => play(last.scene));
  on("compare-fit", compare);

  const veil = at("drop-here");
  addEventListener("dragover", (event) => {
    event.preventDefault();
    veil.hidden = false;
  });
  addEventListener("dragleave", (event) => { veil.hidden ||= event.relatedTarget === null; });
  addEventListener("drop", (event) => {
    event.preventDefault();
    veil.hidden = true;
    take([...event.dataTransfer.files]);
  });
  addEventListener("paste", (event) => {
    if (event.target.closest?.("input, textarea")) return;
    const pasted = [...event.clipboardData.files];
    const text = event.clipboardData.getData("text/plain");
    if (pasted.length > 0) take(pasted);
    else if (text.trim() !== "") of("pasted.tsv", text);
  });
  return of("squash-on-cement.csv", EXAMPLE);
}
