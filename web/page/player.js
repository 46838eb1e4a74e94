// A moving picture with its buttons: whatever can be drawn at a time plays, pauses and goes frame
// by frame.

import { made, say } from "./elements.js";

/// One step of the arrow keys, s.
const FRAME = 1 / 60;
/// Colours of balls apart for every common kind of colour blindness, as files for animators have
/// them.
export const COLOURS = ["#d9541a", "#0a61b5", "#007d5c", "#a14a99", "#b8860b"];

/// Puts a player into `element`; `paint(context, size, t)` draws and says what is to be read at t.
export function player(element, paint) {
  const canvas = made("canvas", { role: "img", tabIndex: 0 });
  const clock = made("output", { className: "clock" });
  const toggle = made("button", { type: "button" });
  const back = made("button", { type: "button", textContent: say("player.back") });
  const on = made("button", { type: "button", textContent: say("player.on") });
  const time = made("input", { type: "range", min: 0, max: 1, step: "any", value: 0 });
  const rates = [1, 0.5, 0.25, 0.1].map((rate) => made("option", { value: rate, textContent: `${rate} ×` }));
  const rate = made("select", {}, ...rates);
  const bar = made("div", { className: "row" }, toggle, back, on,
    made("label", { className: "grow" }, say("player.time"), " ", time), made("label", {}, say("player.speed"), " ", rate));
  element.append(canvas, bar, clock);

  const still = matchMedia("(prefers-reduced-motion: reduce)");
  let [t, until, playing, before] = [0, 1, false, undefined];

  function show() {
    const [width, height, ratio] = [canvas.clientWidth, canvas.clientHeight, devicePixelRatio || 1];
    if (width === 0) return;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    const context = canvas.getContext("2d");
    context.scale(ratio, ratio);
    const { color: ink, borderTopColor: line } = getComputedStyle(canvas);
    const read = paint(context, { width, height, ink, line }, t);
    time.value = t;
    const now = say("player.now", { t: t.toFixed(3), until: until.toFixed(3) });
    time.setAttribute("aria-valuetext", now);
    clock.textContent = [now, ...read].join("; ");
  }
  function set(wanted) {
    playing = wanted;
    before = undefined;
    toggle.textContent = say(playing ? "player.pause" : "player.play");
    if (playing) requestAnimationFrame(step);
  }
  function step(now) {
    if (!playing) return;
    if (before !== undefined) t += (Number(rate.value) * (now - before)) / 1000;
    before = now;
    if (t >= until) {
      t = until;
      set(false);
    }
    show();
    if (playing) requestAnimationFrame(step);
  }
  const go = (to) => {
    set(false);
    t = Math.min(until, Math.max(0, to));
    show();
  };
  const press = () => {
    if (!playing && t >= until) t = 0;
    set(!playing);
  };
  toggle.addEventListener("click", press);
  back.addEventListener("click", () => go(t - FRAME));
  on.addEventListener("click", () => go(t + FRAME));
  time.addEventListener("input", () => go(Number(time.value)));
  canvas.setAttribute("aria-label", say("player.picture"));
  canvas.addEventListener("keydown", (event) => {
    const act = { " ": press, ArrowLeft: () => go(t - FRAME), ArrowRight: () => go(t + FRAME), Home: () => go(0), End: () => go(until) }[event.key];
    if (act === undefined) return;
    event.preventDefault();
    act();
  });
  new ResizeObserver(show).observe(canvas);
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", show);
  set(false);

  return {
    /// Another motion, that lasts so long; it starts anew unless `kept`.
    load(lasts, kept = false) {
      until = lasts;
      time.max = lasts;
      if (kept) t = Math.min(t, until);
      else {
        t = 0;
        set(!still.matches);
      }
      show();
    },
    stop: () => set(false),
    show,
  };
}
