// The page: its tabs, and what follows on what.

import { SCENES } from "./parts.js";
import { end, watch } from "./engine.js";
import { at } from "./elements.js";
import { listeners, measure } from "./measure.js";
import { linked, load, pause, play, resume } from "./play.js";
import { compare, compared, halt, restart } from "./compare.js";

const TABS = ["measure", "play", "compare"];

function tab(name, focus = false) {
  for (const other of TABS) {
    const chosen = other === name;
    at(other).hidden = !chosen;
    at(`tab-${other}`).setAttribute("aria-selected", chosen);
    at(`tab-${other}`).tabIndex = chosen ? 0 : -1;
  }
  if (focus) at(`tab-${name}`).focus();
  pause();
  halt();
  if (name === "play") resume();
  if (name === "compare") restart();
}

for (const [n, name] of TABS.entries()) {
  at(`tab-${name}`).addEventListener("click", () => tab(name));
  at(`tab-${name}`).addEventListener("keydown", (event) => {
    const to = { ArrowLeft: n - 1, ArrowRight: n + 1, Home: 0, End: TABS.length - 1 }[event.key];
    if (to !== undefined) tab(TABS.at(to % TABS.length), true);
  });
}
at("stop").addEventListener("click", () => end("stopped"));
watch((busy) => { at("busy").hidden = !busy; });

play();
compare();
listeners.push(compared);
const first = linked();
if (first !== null) tab("play");
const fitted = measure(
  (toml) => {
    tab("play");
    load(toml);
  },
  () => tab("compare"),
);
// The first answer is the fit, unless an address asks for a scene.
const [[name, own]] = Object.entries(SCENES);
if (first === null) fitted.then(() => load(own, name));
else load(first);
addEventListener("hashchange", () => {
  const toml = linked();
  if (toml === null) return;
  tab("play");
  load(toml);
});
performance.mark("asked");
fitted.then(() => { document.documentElement.dataset.ready = performance.now().toFixed(1); });
