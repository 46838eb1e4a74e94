// The page's elements: found, made, shown, saved. Text is only ever put in as text.

import { WORDS } from "./parts.js";

export const at = (id) => document.getElementById(id);

/// The words of the interface, with `{name}` replaced by values.
export function say(key, values = {}) {
  const words = WORDS[key] ?? key;
  return words.replace(/\{(\w+)\}/g, (whole, name) => values[name] ?? whole);
}

/// A new element with properties and children.
export function made(tag, properties = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name.includes("-") || name === "role" || name === "for") element.setAttribute(name, value);
    else element[name] = value;
  }
  element.append(...children);
  return element;
}

/// Announces something.
export const tell = (text) => { at("said").textContent = text; };

/// Hands bytes or text to the browser to be saved.
export function save(name, content, type, says = "") {
  const address = URL.createObjectURL(new Blob([content], { type }));
  made("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 60_000);
  tell(say("saved", { name, says }));
}

/// Shows pictures `[kind, svg]`, each as an image, which runs nothing; those that are there already
/// change in place.
export function draw(figure, pictures) {
  const kept = new Map([...figure.children].map((image) => [image.dataset.kind, image]));
  for (const [kind, svg] of pictures) {
    const image = kept.get(kind) ?? figure.appendChild(made("img", { "data-kind": kind, alt: say(`picture.${kind}`) }));
    kept.delete(kind);
    const before = image.src;
    image.src = URL.createObjectURL(new Blob([svg], { type: "image/svg+xml" }));
    if (before) URL.revokeObjectURL(before);
  }
  for (const image of kept.values()) {
    URL.revokeObjectURL(image.src);
    image.remove();
  }
}

/// Shows a problem, or that there is none.
export function problem(element, error) {
  element.hidden = error === undefined;
  element.textContent = error === undefined ? "" : error.says ?? error.message;
}

/// A length for people.
export function length(metres) {
  const size = Math.abs(metres);
  if (size < 0.00995) return `${(1000 * metres).toFixed(2)} mm`;
  return size < 0.9995 ? `${(100 * metres).toFixed(1)} cm` : `${metres.toFixed(3)} m`;
}
