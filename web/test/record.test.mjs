// Recordings: by a microphone that plays a file, and as telephones save them.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fitted, give, on, pictures, root, saved, start, stop } from "./browser.mjs";

/// pingpong.m4a is this recording after `ffmpeg -i pingpong.wav -c:a aac -b:a 64k pingpong.m4a`, under
/// its licence.
const wav = join(root, "examples/data/pingpong.wav");
/// Half a second of rest, the recording, and a second of rest: what a hand records.
const played = join(pictures, "microphone.wav");
const HEAD = 44;
const RATE = 44_100;
const BYTES = 2;

before(() => {
  const sound = readFileSync(wav);
  const at = sound.indexOf("data");
  const samples = sound.subarray(at + 8, at + 8 + sound.readUInt32LE(at + 4));
  const head = Buffer.alloc(HEAD);
  const size = samples.length + 1.5 * RATE * BYTES;
  head.write("RIFF");
  head.writeUInt32LE(HEAD - 8 + size, 4);
  head.write("WAVEfmt ", 8);
  head.writeUInt32LE(16, 16);
  head.writeUInt16LE(1, 20);
  head.writeUInt16LE(1, 22);
  head.writeUInt32LE(RATE, 24);
  head.writeUInt32LE(RATE * BYTES, 28);
  head.writeUInt16LE(BYTES, 32);
  head.writeUInt16LE(8 * BYTES, 34);
  head.write("data", 36);
  head.writeUInt32LE(size, 40);
  writeFileSync(played, Buffer.concat([head, Buffer.alloc(0.5 * RATE * BYTES), samples, Buffer.alloc(RATE * BYTES)]));
  return start("--use-fake-ui-for-media-stream", "--use-fake-device-for-media-stream", `--use-file-for-fake-audio-capture=${played}%noloop`);
});
after(stop);

const { value: cor, standard_error: own } = fitted([wav]).cor;
/// Two recordings of one drop are no farther apart than the errors of both allow.
const near = ({ cor: { value, standard_error: error } }) =>
  assert.ok(Math.abs(value - cor) < Math.hypot(error, own), `${value} ± ${error} is not ${cor} ± ${own}`);

for (const [form, known] of [["without loss", () => true], ["as opus", (type) => /opus/.test(type)]]) {
  test(`the microphone records ${form}, the level moves, and the sound is fitted`, () =>
    on(async (page) => {
      await page.evaluate((source) => { MediaRecorder.isTypeSupported = new Function(`return ${source}`)(); }, String(known));
      await page.click("#record");
      await page.waitForSelector("#recording:not([hidden])");
      const levels = await page.evaluate(() => new Promise((done) => {
        const seen = [];
        const look = () => (seen.push(document.getElementById("level").value), seen.length < 240 ? requestAnimationFrame(look) : done(seen));
        look();
      }));
      assert.ok(Math.max(...levels) > 0.5 && Math.min(...levels) < 0.3, `levels from ${Math.min(...levels)} to ${Math.max(...levels)}`);
      await page.waitForFunction(() => parseFloat(document.getElementById("recorded").textContent) >= 5);
      await page.click("#record");
      await page.waitForFunction(() => document.getElementById("said").textContent.startsWith("recording."));
      const got = JSON.parse((await saved(page, "#save-json")).bytes);
      console.log(`recorded ${form}: COR ${got.cor?.value}, ${got.verdict}; the file itself ${cor}`);
      near(got);
      assert.equal((await saved(page, "#save-wav")).bytes.toString("latin1", 0, 4), "RIFF");
      assert.equal(await page.isVisible("#recording"), false);
    }));
}

test("a telephone's m4a is fitted as the recording that it was made of", () =>
  on(async (page) => {
    await give(page, [{ name: "pingpong.m4a", bytes: readFileSync(join(import.meta.dirname, "pingpong.m4a")) }]);
    const got = JSON.parse((await saved(page, "#save-json")).bytes);
    console.log(`m4a: COR ${got.cor.value}; the WAV ${cor}`);
    near(got);
  }));

test("without a microphone it is said, and the table stays", () =>
  on(async (page) => {
    await page.evaluate(() => { navigator.mediaDevices.getUserMedia = () => Promise.reject(new Error("Permission denied")); });
    await page.click("#record");
    await page.waitForFunction(() => document.getElementById("said").textContent.includes("Permission denied"));
    assert.equal(await page.textContent("#verdict"), "Doubtful");
  }));
