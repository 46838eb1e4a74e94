// The Worker: opens the compiled part, then answers one question after the other.

/// Names the compiled part asks for are of clocks of its libraries, which no result depends on.
const nothing = () => 0;

/// The bytes of a text of seven bits to a character, the lowest first; pack.mjs writes it.
function unpacked(text) {
  const bytes = new Uint8Array(Math.floor((7 * text.length) / 8));
  let [held, bits, count] = [0, 0, 0];
  for (let n = 0; n < text.length; n += 1) {
    held |= (text.charCodeAt(n) & 0x7f) << bits;
    bits += 7;
    if (bits >= 8) {
      bytes[count] = held & 0xff;
      count += 1;
      held >>= 8;
      bits -= 8;
    }
  }
  return bytes;
}

async function open(text) {
  const bytes = new ReadableStream({ start: (queue) => (queue.enqueue(unpacked(text)), queue.close()) });
  const stream = bytes.pipeThrough(new DecompressionStream("gzip"));
  const headers = { "content-type": "application/wasm" };
  const module = await WebAssembly.compileStreaming(new Response(stream, { headers }));
  const imports = {};
  for (const { module: from, name } of WebAssembly.Module.imports(module)) (imports[from] ??= {})[name] = nothing;
  return (await WebAssembly.instantiate(module, imports)).exports;
}

let ready;

async function answer({ id, question }) {
  const { room, answer, place, memory } = await ready;
  const at = room(question.byteLength);
  new Uint8Array(memory.buffer, at, question.byteLength).set(new Uint8Array(question));
  const length = answer();
  const bytes = memory.buffer.slice(place(), place() + length);
  postMessage({ id, bytes }, [bytes]);
}

onmessage = ({ data }) => {
  if (data.wasm !== undefined) {
    ready = open(data.wasm);
    ready.catch((error) => postMessage({ broken: String(error) }));
  } else {
    answer(data).catch((error) => postMessage({ id: data.id, ended: String(error) }));
  }
};
