// Puts the parts of the page together: node web/build.mjs COMPILED.wasm PACK SALTUS.html [LANGUAGE]
import { createHash } from "node:crypto";
import { readFileSync, readdirSync, statSync, writeFileSync } from "node:fs";
import { basename, join } from "node:path";
import { packed } from "./pack.mjs";

const here = import.meta.dirname;
const [wasm, pack, page, language = "en"] = process.argv.slice(2);
const read = (...path) => readFileSync(join(here, ...path), "utf8");
/// A script without its remarks, which a page's reader has no use for.
const bare = (script) => script.replace(/^ *\/\/.*\n/gm, "");
const words = JSON.parse(read("words", `${language}.json`));

const OWN = `# A ball of your own: move a slider, or write here. docs/use/scenes.md lists the keys.
gravity = "9.81 m/s^2"
restitution = 0.75
friction = 0.4

[ball]
name = "tennis ball"
shape = "hollow"
diameter = "66 mm"
mass = "58 g"
height = "1 m"
spin = "0 rev/s" # from x towards up is positive

[floor]
kind = "incline"
angle = "0 deg"

[drag]
coefficient = 0.5

[run]
until = "4 s"
`;

function scenes() {
  const folder = join(here, "../examples/scenes");
  const files = readdirSync(folder).filter((name) => name.endsWith(".toml")).sort();
  const text = (name) => readFileSync(join(folder, name), "utf8").replace(/^#:schema.*\n/, "");
  return Object.fromEntries([[words["play.own"], OWN], ...files.map((name) => [basename(name, ".toml"), text(name)])]);
}

/// What the modules import from parts.js.
const parts = {
  WORDS: words,
  EXAMPLE: read("../examples/data/squash-on-cement.csv"),
  SCENES: scenes(),
};

/// The modules in one, each a function that gives what it exports, after those that it imports.
function joined(entry) {
  const done = new Set(["parts"]);
  const text = [`const $parts = ${JSON.stringify(parts)};`];
  const name = (file) => file.replace(/^\.\/(.*)\.js$/, "$1");
  function add(module) {
    if (done.has(module)) return;
    done.add(module);
    const exported = [];
    const body = bare(read("page", `${module}.js`))
      .replace(/^import (\{.*\}) from "(.*)";$/gm, (_, names, from) => {
        add(name(from));
        return `const ${names} = $${name(from)};`;
      })
      .replace(/^export (async function|function|const) (\w+)/gm, (_, kind, what) => {
        exported.push(what);
        return `${kind} ${what}`;
      });
    text.push(`const $${module} = (() => {\n${body}\nreturn { ${exported.join(", ")} };\n})();`);
  }
  add(entry);
  return whole(text.join("\n"));
}

/// No text ends the script before its end.
const whole = (script) => script.replaceAll("</", "<\\/");

const hash = (text) => `'sha256-${createHash("sha256").update(text).digest("base64")}'`;
const escaped = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll('"', "&quot;");

const style = read("page/style.css");
const begin = whole(`const WORKER = ${JSON.stringify(bare(read("page/worker.js")))};\n${bare(read("page/begin.js"))}`);
const script = joined("main");
// Nothing is loaded from anywhere, nothing in a table runs, and nothing is sent.
const policy = [
  "default-src 'none'",
  `script-src ${hash(begin)} ${hash(script)} 'wasm-unsafe-eval'`,
  "worker-src blob:",
  `style-src ${hash(style)}`,
  "img-src blob: data:",
  "base-uri 'none'",
  "form-action 'none'",
].join("; ");
const filled = { POLICY: policy, STYLE: style, BEGIN: begin, SCRIPT: script, WASM: packed(wasm, pack) };
/// A word of the interface, which every language has to have.
function word(key) {
  if (!(key in words)) throw new Error(`words/${language}.json has no "${key}"`);
  return words[key];
}
for (const key of Object.keys(JSON.parse(read("words/en.json")))) word(key);
const html = read("page.html")
  .replace(/\{\{([\w.]+)\}\}/g, (_, key) => escaped(word(key)))
  .replace(/@(POLICY|STYLE|BEGIN|SCRIPT|WASM)@/g, (_, key) => filled[key]);
// The mark at the start says UTF-8 whatever a server says.
writeFileSync(page, `\ufeff${html}`);
console.log(`${page}: ${(statSync(page).size / 1e6).toFixed(2)} MB`);
