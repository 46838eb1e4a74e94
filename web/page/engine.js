// Questions to the Worker. It is ended when it breaks down or takes too long, and another started.

import { say } from "./elements.js";

/// How long an answer may take, s.
const PATIENCE = 30;

/// The compiled part, packed, as text.
const wasm = document.getElementById("wasm").textContent;
const waiting = new Map();
/// After how long a page that computes says so, ms.
const QUIET = 300;
let worker;
let count = 0;
let changed = () => {};
let quiet;

/// Takes a Worker of `begin.js`, which nobody has asked yet.
function start(one) {
  worker = one;
  worker.onmessage = ({ data }) => {
    // What does not start would not start again.
    if (data.broken !== undefined) failed("start");
    else if (data.ended !== undefined) end("ended");
    else settle(data.id, (asked) => asked.done(opened(data.bytes)));
  };
  worker.onerror = (event) => {
    event.preventDefault();
    end("ended");
  };
  worker.postMessage({ wasm });
}

function settle(id, by) {
  const asked = waiting.get(id);
  if (asked === undefined) return;
  waiting.delete(id);
  clearTimeout(asked.timer);
  if (waiting.size === 0) {
    clearTimeout(quiet);
    quiet = undefined;
    changed(false);
  }
  by(asked);
}

/// Whatever is asked fails for this reason.
function failed(kind, values) {
  for (const id of [...waiting.keys()]) settle(id, (asked) => asked.fail({ kind, message: say(`failed.${kind}`, values) }));
}

/// Ends the Worker: the next question finds a new one.
export function end(kind, values = {}) {
  worker.onmessage = null;
  worker.terminate();
  start(begun());
  failed(kind, values);
}

/// The JSON of a message and the bytes behind it.
function opened(bytes) {
  const length = new DataView(bytes).getUint32(0, true);
  const json = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
  return { ...json, bytes: bytes.slice(4 + length) };
}

/// Asks for what `json` says, with the bytes behind it: the answer, or `{ kind, message, … }`
/// thrown.
export function ask(json, parts = []) {
  const head = new TextEncoder().encode(JSON.stringify(json));
  const length = parts.reduce((sum, part) => sum + part.length, 4 + head.length);
  const question = new Uint8Array(length);
  new DataView(question.buffer).setUint32(0, head.length, true);
  question.set(head, 4);
  let at = 4 + head.length;
  for (const part of parts) {
    question.set(part, at);
    at += part.length;
  }
  return new Promise((done, fail) => {
    const id = (count += 1);
    const timer = setTimeout(() => end("long", { seconds: PATIENCE }), 1000 * PATIENCE);
    quiet ??= setTimeout(() => changed(true), QUIET);
    waiting.set(id, { timer, fail, done: (answer) => (answer.error ? fail(answer.error) : done(answer)) });
    worker.postMessage({ id, question: question.buffer }, [question.buffer]);
  });
}

/// Calls `listener` with whether answers are long in coming.
export const watch = (listener) => { changed = listener; };

start(first);
