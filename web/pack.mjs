// Compiled bytes as text in a page: without notes for tools, packed, and seven bits to a character.
import { gzipSync } from "node:zlib";

/// Sections of a WebAssembly module that hold no part of the program have the number 0.
const NOTES = 0;
/// Characters that a page may not hold as they are, or that do not survive: the end of text, ends
/// of lines, and the start of a tag.
const UNSAFE = new Set([0x00, 0x0a, 0x0d, 0x3c]);
/// What is added to them; the lowest seven bits stay.
const LIFT = 0x100;

/// The module without sections for tools.
function bare(module) {
  const kept = [module.subarray(0, 8)];
  for (let at = 8; at < module.length; ) {
    const start = at;
    let [size, shift, byte] = [0, 0, 0];
    at += 1;
    do {
      byte = module[at];
      at += 1;
      size += (byte & 0x7f) * 2 ** shift;
      shift += 7;
    } while (byte & 0x80);
    at += size;
    if (module[start] !== NOTES) kept.push(module.subarray(start, at));
  }
  return Buffer.concat(kept);
}

/// Bytes as characters of seven bits, the lowest first; page/worker.js reads them.
function text(bytes) {
  const codes = new Uint16Array(Math.ceil((8 * bytes.length) / 7));
  let [held, bits, count] = [0, 0, 0];
  const put = (code) => {
    codes[count] = UNSAFE.has(code) ? code + LIFT : code;
    count += 1;
  };
  for (const byte of bytes) {
    held |= byte << bits;
    bits += 8;
    while (bits >= 7) {
      put(held & 0x7f);
      held >>= 7;
      bits -= 7;
    }
  }
  if (bits > 0) put(held);
  return Buffer.from(codes.buffer).toString("utf16le");
}

export const packed = (module) => text(gzipSync(bare(module), { level: 9 }));
