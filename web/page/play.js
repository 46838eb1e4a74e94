// Play: a scene as sliders and as text, its motion and its pictures.

import { SCENES } from "./parts.js";
import { ask } from "./engine.js";
import { at, draw, length, made, problem, save, say, tell } from "./elements.js";
import { COLOURS, player } from "./player.js";

const RANGES = {
  drop: { min: 0, max: 5, step: 0.01, unit: "m" },
  cor: { min: 0, max: 1, step: 0.005, unit: "" },
  gravity: { min: 0, max: 26, step: 0.01, unit: "m/s²" },
  drag: { min: 0, max: 1.5, step: 0.01, unit: "" },
  spin: { min: -60, max: 60, step: 0.5, unit: "rev/s" },
  slope: { min: -45, max: 45, step: 0.5, unit: "°" },
};
const PICTURES = ["height", "energy"];
/// How long a hand rests before typed text is run, and before pictures follow a slider, ms.
const REST = 250;
const STILL = 80;
const MARGIN = 16;

/// The motion that is shown: the answer to the last run, with its places as numbers.
let motion;
let screen;
let queued;
let running = false;
let timer;
let drawing;

/// Where ball `ball` is at t: x and height of its centre.
function place(ball, t) {
  const { places, until, samples, balls } = motion;
  const exact = until > 0 ? (t / until) * (samples - 1) : 0;
  const before = Math.min(samples - 1, Math.floor(exact));
  const after = Math.min(samples - 1, before + 1);
  const value = (sample, part) => places[2 * (sample * balls.length + ball) + part];
  const mix = (part) => value(before, part) + (exact - before) * (value(after, part) - value(before, part));
  return [mix(0), mix(1)];
}

function paint(context, { width, height, ink, line }, t) {
  if (motion === undefined) return [];
  const [left, right, low, high] = motion.bounds;
  const [across, up] = [Math.max(right - left, 1e-3), Math.max(high - low, 1e-3)];
  const scale = Math.min((width - 2 * MARGIN) / across, (height - 2 * MARGIN) / up);
  const x = (value) => width / 2 + scale * (value - (left + right) / 2);
  const y = (value) => height - MARGIN - scale * (value - low);
  context.strokeStyle = line;
  context.lineWidth = 2;
  for (const { points, offsets } of motion.floors) {
    const lift = offsets ? offsets[Math.round((t / motion.until) * (motion.samples - 1))] ?? 0 : 0;
    context.beginPath();
    points.forEach(([px, py], n) => (n ? context.lineTo(x(px), y(py + lift)) : context.moveTo(x(px), y(py + lift))));
    context.stroke();
  }
  const told = [];
  motion.balls.forEach(({ name, radius }, ball) => {
    const [px, py] = place(ball, t);
    if (Number.isNaN(px)) return;
    context.fillStyle = COLOURS[ball % COLOURS.length];
    context.strokeStyle = ink;
    context.lineWidth = 1;
    context.beginPath();
    context.arc(x(px), y(py), Math.max(4, scale * radius), 0, 2 * Math.PI);
    context.fill();
    context.stroke();
    told.push(say("player.height", { name, height: length(py - radius) }));
  });
  return told;
}

function sliders(values) {
  for (const name of Object.keys(RANGES)) {
    const slider = at(`knob-${name}`);
    const value = values[name];
    slider.disabled = value === undefined;
    slider.closest("label").classList.toggle("off", slider.disabled);
    if (value !== undefined) {
      slider.max = Math.max(RANGES[name].max, value);
      slider.min = Math.min(RANGES[name].min, value);
      slider.value = value;
    }
    number(name, value);
  }
}

function number(name, value) {
  const text = value === undefined ? "–" : `${Number(value.toPrecision(5))} ${RANGES[name].unit}`.trim();
  at(`number-${name}`).textContent = text;
  at(`knob-${name}`).setAttribute("aria-valuetext", text);
}

function shown(answer, kept) {
  motion = { ...answer, places: new Float64Array(answer.bytes) };
  if (at("toml").value !== answer.toml) at("toml").value = answer.toml;
  if (answer.knobs) {
    sliders(answer.knobs.values);
    planets(answer.knobs.planets);
  }
  problem(at("scene-problem"));
  at("toml").removeAttribute("aria-invalid");
  at("ended").textContent = [answer.ended, ...answer.doubts].filter(Boolean).join(" ");
  screen.load(motion.until, kept);
}

function planets(known) {
  const select = at("planets");
  if (select.options.length > 1) return;
  select.append(...known.map(([name, value]) => made("option", { value, textContent: `${say(`planet.${name}`)}: ${value} m/s²` })));
}

function refused(error) {
  problem(at("scene-problem"), error);
  at("toml").setAttribute("aria-invalid", "true");
}

/// Runs what is asked last; of what is asked meanwhile only the last.
async function run(wanted, kept) {
  queued = { wanted, kept };
  if (running) return;
  running = true;
  while (queued) {
    const { wanted: now, kept: same } = queued;
    queued = undefined;
    try {
      const began = performance.now();
      shown(await ask({ ask: "run", toml: at("toml").value, ...now }), same);
      at("play").dataset.took = (performance.now() - began).toFixed(2);
      clearTimeout(drawing);
      drawing = setTimeout(pictures, STILL);
    } catch (error) {
      refused(error);
    }
  }
  running = false;
}

/// The pictures of the scene that was run last: they take longer than a frame of the screen.
async function pictures() {
  const { toml } = motion;
  try {
    const answer = await ask({ ask: "run", toml, pictures: PICTURES });
    if (motion.toml === toml) draw(at("run-pictures"), answer.pictures);
  } catch (error) {
    refused(error);
  }
}

/// A scene, by its name in the list if it has one.
export function load(toml, name) {
  at("toml").value = toml;
  at("scenes").value = name ?? "";
  return run({ knobs: true }, false);
}

async function file(format) {
  try {
    const answer = await ask({ ask: "export", toml: at("toml").value, format, fps: "24" });
    const types = { svg: "image/svg+xml", glb: "model/gltf-binary", lottie: "application/json" };
    save(`ball.${format === "lottie" ? "json" : format}`, answer.bytes, types[format], answer.says);
  } catch (error) {
    refused(error);
  }
}

async function effects() {
  try {
    const { rows } = await ask({ ask: "effects", toml: at("toml").value });
    const columns = ["impacts", "apexes", "position", "energy", "missed"];
    const value = (row, name) => {
      if (row[name] === null) return say("effects.more");
      return name === "missed" ? row.missed : Number(((name === "energy" ? 100 : 1) * row[name]).toPrecision(3));
    };
    const line = (row) => {
      const head = made("th", { scope: "row", textContent: say(row.without ? "effects.without" : "effects.with", { effect: row.effect }) });
      if (row.refused !== undefined) return made("tr", {}, head, made("td", { colSpan: columns.length, textContent: row.refused }));
      return made("tr", {}, head, ...columns.map((name) => made("td", { textContent: value(row, name) })));
    };
    const heads = ["effect", ...columns].map((name) => made("th", { scope: "col", textContent: say(`effects.${name}`) }));
    const table = made("table", {}, made("thead", {}, made("tr", {}, ...heads)), made("tbody", {}, ...rows.map(line)));
    at("effects-table").replaceChildren(table);
    at("effects-table").hidden = false;
  } catch (error) {
    refused(error);
  }
}

/// The scene that the address holds.
export const linked = () => new URLSearchParams(location.hash.slice(1)).get("scene");

export function play() {
  screen = player(at("stage"), paint);
  at("scenes").append(...Object.keys(SCENES).map((name) => made("option", { value: name, textContent: name })));
  at("scenes").addEventListener("change", ({ target: { value } }) => load(SCENES[value], value));
  at("planets").append(made("option", { value: "", textContent: say("planet.none") }));
  at("planets").addEventListener("change", () => {
    if (at("planets").value !== "") turned("gravity", Number(at("planets").value));
    at("planets").value = "";
  });
  const turned = (name, value) => {
    at(`knob-${name}`).value = value;
    number(name, value);
    run({ set: [name, value], knobs: false }, true);
  };
  for (const [name, { min, max, step }] of Object.entries(RANGES)) {
    const slider = made("input", { id: `knob-${name}`, type: "range", min, max, step, disabled: true });
    slider.addEventListener("input", () => turned(name, slider.valueAsNumber));
    at("knobs").append(made("label", {}, say(`knob.${name}`), " ", made("output", { id: `number-${name}` }), slider));
  }
  at("toml").addEventListener("input", () => {
    clearTimeout(timer);
    timer = setTimeout(() => run({ knobs: true }, true), REST);
  });
  for (const button of document.querySelectorAll("[data-export]")) button.addEventListener("click", () => file(button.dataset.export));
  at("save-toml").addEventListener("click", () => save("ball.toml", at("toml").value, "application/toml"));
  at("effects").addEventListener("click", effects);
  at("link").addEventListener("click", () => {
    history.replaceState(null, "", `#${new URLSearchParams({ scene: at("toml").value })}`);
    navigator.clipboard?.writeText(location.href).catch(() => {});
    tell(say("play.linked"));
  });
}

export const pause = () => screen.stop();
export const resume = () => screen.show();
