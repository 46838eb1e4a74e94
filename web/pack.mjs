// Compiled bytes as text in a page: without notes and names for tools, packed, and seven bits to a
// character.
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { existsSync, readFileSync, renameSync, writeFileSync } from "node:fs";

/// Sections of a WebAssembly module that hold no part of the program have the number 0, that of the
/// names by which it is called 7.
const NOTES = 0;
const NAMES = 7;
/// What libraries name for tools that write bindings: thousands of names, which take longer to make
/// than the program itself.
const FOR_TOOLS = /^_/;
/// Characters that a page may not hold as they are, or that do not survive: the end of text, ends
/// of lines, and the start of a tag.
const UNSAFE = new Set([0x00, 0x0a, 0x0d, 0x3c]);
/// What is added to them; the lowest seven bits stay, and every character is one byte in memory.
const LIFT = 0x80;

/// The number of a module at `at`, seven bits to a byte, and where it ends.
function number(module, at) {
  let [value, shift, byte] = [0, 0, 0];
  do {
    byte = module[at];
    at += 1;
    value += (byte & 0x7f) * 2 ** shift;
    shift += 7;
  } while (byte & 0x80);
  return [value, at];
}

/// A number as a module has it.
function numbered(value) {
  const bytes = [];
  for (; value > 0x7f; value >>= 7) bytes.push(0x80 | (value & 0x7f));
  return Buffer.from([...bytes, value]);
}

/// The names of a section without those for tools.
function called(section) {
  const kept = [];
  let [count, at] = number(section, 0);
  for (; count > 0; count -= 1) {
    const start = at;
    const [length, name] = number(section, at);
    // Behind the name its kind, a byte, and its number.
    at = number(section, name + length + 1)[1];
    if (!FOR_TOOLS.test(section.toString("utf8", name, name + length))) kept.push(section.subarray(start, at));
  }
  return Buffer.concat([numbered(kept.length), ...kept]);
}

/// The module without what is for tools.
function bare(module) {
  const kept = [module.subarray(0, 8)];
  for (let at = 8; at < module.length; ) {
    const kind = module[at];
    const [size, start] = number(module, at + 1);
    at = start + size;
    const section = module.subarray(start, at);
    const content = kind === NAMES ? called(section) : section;
    if (kind !== NOTES) kept.push(Buffer.from([kind]), numbered(content.length), content);
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

/// What a program packs of its input. That takes half a minute, so it is kept beside the module,
/// under what it was made of and by.
function gzip(bytes, pack, beside) {
  const hash = createHash("sha256").update(bytes).update(readFileSync(pack)).digest("hex");
  const kept = `${beside}.${hash.slice(0, 16)}.gz`;
  if (existsSync(kept)) return readFileSync(kept);
  const packed = execFileSync(pack, { input: bytes, maxBuffer: Infinity });
  // Under its name it is whole: a build that is stopped, or another beside it, leaves no half file.
  writeFileSync(`${kept}.${process.pid}`, packed);
  renameSync(`${kept}.${process.pid}`, kept);
  return packed;
}

export const packed = (file, pack) => text(gzip(bare(readFileSync(file)), pack, file));
