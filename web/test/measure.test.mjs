// Measure: what the page fits is what the tool fits; nothing in a file is more than text.
import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, readdirSync, statSync, writeFileSync } from "node:fs";
import { createServer } from "node:http";
import { tmpdir } from "node:os";
import { basename, join } from "node:path";
import { after, before, test } from "node:test";
import { kept, planted } from "./altered.mjs";
import { alike, fitted, give, html, on, root, saved, start, stop, told } from "./browser.mjs";

before(() => start());
after(stop);

const tables = (folder) => readdirSync(join(root, folder)).map((name) => join(root, folder, name));
const file = (path) => ({ name: basename(path), bytes: readFileSync(path) });
/// A share of the many files that people handed in; all of them with SHARE=1.
const share = Number(process.env.SHARE ?? 12);
const handed = tables("crates/saltus-fit/tests/handed").filter((_, n) => n % share === 0);
const known = [...tables("examples/data").filter((path) => path.endsWith(".csv")), ...tables("crates/saltus-fit/tests/tables"), ...handed].filter((path) => statSync(path).isFile());

test("it opens with a fit, is small, and asks nobody", async () => {
  const size = statSync(html).size;
  const opened = [];
  for (let n = 0; n < 5; n += 1) {
    await on(async (page) => {
      opened.push(await page.evaluate(() => [
        Number(document.documentElement.dataset.ready),
        performance.getEntriesByName("asked")[0].startTime,
        performance.getEntriesByType("navigation")[0].responseEnd,
      ]));
      assert.equal(await page.textContent("#verdict"), "Doubtful");
      assert.match(await page.textContent("#headline"), /between 0\.41 and 0\.75/);
      // Names for tools, of which libraries have thousands, are made for nobody.
      assert.deepEqual((await page.workers()[0].evaluate(async () => Object.keys(await ready))).sort(), ["answer", "memory", "place", "room"]);
    });
  }
  const [fitted, asked, read] = opened.sort(([a], [b]) => a - b)[0].map(Math.round);
  console.log(`saltus.html: ${(size / 1e6).toFixed(2)} MB; fastest of ${opened.length}: read after ${read} ms, asked after ${asked}, fitted after ${fitted}`);
  assert.ok(size <= 3e6);
});

test("it opens from a server", async () => {
  const server = createServer((_, answer) => answer.setHeader("content-type", "text/html").end(readFileSync(html)));
  await new Promise((done) => server.listen(0, "127.0.0.1", done));
  const url = `http://127.0.0.1:${server.address().port}/`;
  await on(async (page) => assert.equal(await page.textContent("#verdict"), "Doubtful"), { url, offline: false });
  server.close();
});

test(`${known.length} files are fitted as by the tool`, () =>
  on(async (page) => {
    const different = {};
    let read = 0;
    for (const path of known) {
      const wanted = fitted([path]);
      await give(page, [file(path)]);
      try {
        if (wanted.error) {
          const says = await page.textContent("#problem");
          assert.ok(says.includes(wanted.error.message), says);
        } else {
          assert.equal(await page.isVisible("#save-json"), true, await page.textContent("#problem"));
          const got = JSON.parse((await saved(page, "#save-json")).bytes);
          assert.equal(got.verdict, wanted.verdict);
          read += 1;
          assert.equal((await page.textContent("#text")).trim(), told(path));
          alike(got, wanted);
        }
      } catch (error) {
        different[basename(path)] = error.message.slice(0, 200);
      }
    }
    console.log(`${read} reports, ${known.length - read} refusals`);
    assert.deepEqual(different, {});
    assert.ok(read > known.length / 3);
  }));

test("sounds are heard, by the browser's decoder where they are no WAV", () =>
  on(async (page) => {
    const path = join(root, "examples/data/pingpong.wav");
    await give(page, [file(path)]);
    const wanted = fitted([path]);
    alike(JSON.parse((await saved(page, "#save-json")).bytes), wanted);
    assert.equal(await page.locator("#fit-pictures img").first().getAttribute("data-kind"), "motion");
    // The decoder looks at the bytes and not at the name; it gives another rate.
    await give(page, [{ name: "drop.m4a", bytes: readFileSync(path) }]);
    const got = JSON.parse((await saved(page, "#save-json")).bytes);
    assert.equal(got.table, "drop.wav");
    assert.ok(Math.abs(got.cor.value - wanted.cor.value) < 0.0005, `${got.cor.value} is not ${wanted.cor.value}`);
    await give(page, [{ name: "noise.mp3", bytes: Buffer.from("no sound at all") }]);
    assert.equal(await page.textContent("#verdict"), "Not read");
    await page.click("#options summary");
    await page.fill("#option-listen", "0s..2s");
    await give(page, [file(path)]);
    alike(JSON.parse((await saved(page, "#save-json")).bytes), fitted([path], "--listen", "0s..2s"));
  }));

test("several files are one table", () =>
  on(async (page) => {
    const paths = ["intervals.csv", "stopwatch.csv"].map((name) => join(root, "crates/saltus-fit/tests/tables", name));
    await give(page, paths.map(file));
    alike(JSON.parse((await saved(page, "#save-json")).bytes), fitted(paths));
  }));

test("what the table does not say can be stated", () =>
  on(async (page) => {
    await page.click("#options summary");
    const state = async (options) => {
      for (const [name, value] of Object.entries(options)) await page.fill(`#option-${name}`, value);
    };
    const squash = join(root, "examples/data/squash-on-cement.csv");
    await state({ sigma_height: "5 mm", sigma_time: "3 ms", sigma_zero: "0", gravity: "9.81 m/s^2", ball: "squash" });
    await give(page, [file(squash)]);
    const flags = ["--sigma-height", "5mm", "--sigma-time", "3ms", "--sigma-zero", "0", "--gravity", "9.81m/s^2", "--ball", "squash"];
    alike(JSON.parse((await saved(page, "#save-json")).bytes), fitted([squash], ...flags));
    await state({ sigma_height: "5" });
    await page.press("#option-sigma_height", "Tab");
    await page.waitForFunction(() => document.getElementById("problem").textContent.includes("has no unit"));

    await state({ sigma_height: "", sigma_time: "", sigma_zero: "", gravity: "", ball: "4 cm", drag: "0.02" });
    const bare = join(mkdtempSync(join(tmpdir(), "saltus-")), "bare.txt");
    writeFileSync(bare, "64\n41\n26.2\n16.8\n");
    await state({ header: "height", height_unit: "cm", drop: "1 m", zero: "0", direction: "up" });
    await give(page, [file(bare)]);
    const wanted = fitted([bare], "--header", "height", "--height-unit", "cm", "--drop", "1m", "--zero", "0", "--y-up", "--ball", "4cm", "--drag", "0.02");
    assert.equal(wanted.error, undefined);
    alike(JSON.parse((await saved(page, "#save-json")).bytes), wanted);
  }));

test("a cell that is edited changes the fit and nothing else in the file", () =>
  on(async (page) => {
    const text = "# mine\r\nbounce;height_cm\r\n0;100\r\n1;64,0\r\n2;41\r\n3;26,2\r\n";
    await give(page, [{ name: "mine.csv", bytes: text }]);
    const first = await page.textContent("#headline");
    await page.focus('[data-place="3:1"]');
    await page.keyboard.press("ArrowDown");
    await page.keyboard.type("40,5");
    await page.waitForFunction((before) => document.getElementById("headline").textContent !== before, first);
    assert.equal(String((await saved(page, "#save-csv")).bytes), text.replace("41", "40,5"));
    await page.fill('[data-place="3:1"]', "1.2.3");
    await page.waitForSelector('[data-place="3:1"][aria-invalid]');
    assert.match(await page.textContent("#problem"), /mine\.csv:4:3: '1\.2\.3' is not a number/);
  }));

test("a table is typed by keyboard alone, or pasted", () =>
  on(async (page) => {
    await page.focus("#blank");
    await page.keyboard.press("Enter");
    await page.focus('[data-place="1:1"]');
    for (const height of ["100", "64", "41", "26.2"]) {
      await page.keyboard.type(height);
      await page.keyboard.press("Enter");
    }
    await page.waitForFunction(() => /0\.8/.test(document.getElementById("headline").textContent));
    const paste = (where, text) => page.evaluate(([selector, pasted]) => {
      const data = new DataTransfer();
      data.setData("text/plain", pasted);
      document.querySelector(selector).dispatchEvent(new ClipboardEvent("paste", { clipboardData: data, bubbles: true, cancelable: true }));
    }, [where, text]);
    await paste("body", "bounce\theight (cm)\n0\t100\n1\t49\n2\t24\n3\t11.8\n");
    await page.waitForFunction(() => /0\.7/.test(document.getElementById("headline").textContent));
    // Into a cell: from there on, with decimal commas, and with more rows than there are.
    await page.click("#blank");
    await page.waitForSelector('[data-place="4:1"]');
    const heights = Array.from({ length: 8 }, (_, n) => (100 * 0.36 ** n).toFixed(3).replace(".", ","));
    await paste('[data-place="1:0"]', heights.map((height, n) => `${n}\t${height}`).join("\r\n"));
    await page.waitForFunction(() => /0\.60/.test(document.getElementById("headline").textContent));
    assert.equal(String((await saved(page, "#save-csv")).bytes), `bounce\theight_cm\n${heights.map((height, n) => `${n}\t${height}\n`).join("")}`);
  }));

test("names and cells are only text", () =>
  on(async (page) => {
    const evil = '<img src=x onerror="document.title=1">';
    const text = `${evil},height_cm,"${evil.replaceAll('"', '""')}"\n0,100,a\n1,64,${evil}\n2,41,<script>document.title=1</script>\n`;
    const title = await page.title();
    for (const name of [`${evil}.csv`, "'\"><svg onload=document.title=1>.csv"]) {
      await give(page, [{ name, bytes: text }]);
      await give(page, [{ name, bytes: `${evil}` }, { name: `b${name}`, bytes: text }]);
    }
    await page.waitForTimeout(100);
    assert.equal(await page.title(), title);
    assert.equal(await page.locator("img:not([src^='blob:'])").count(), 0);
    assert.equal(await page.locator("main script, main svg").count(), 0);
  }));

test("a file of 100 MB is refused, and the page stays awake", () =>
  on(async (page) => {
    await page.evaluate(() => {
      const data = new DataTransfer();
      data.items.add(new File([new Uint8Array(100e6)], "large.csv"));
      dispatchEvent(new DragEvent("drop", { dataTransfer: data }));
    });
    await page.waitForFunction(() => document.getElementById("problem").textContent.includes("100 MB"));
    await page.click("#example");
    await page.waitForFunction(() => document.getElementById("verdict").textContent === "Doubtful");
  }));

test("what cannot be read is said", () =>
  on(async (page) => {
    await page.evaluate(() => {
      const [data, event] = [new File([], "a folder"), new Event("drop", { cancelable: true })];
      data.arrayBuffer = () => Promise.reject(new DOMException("gone", "NotFoundError"));
      event.dataTransfer = { files: [data] };
      dispatchEvent(event);
    });
    await page.waitForFunction(() => document.getElementById("problem").textContent.startsWith("a folder cannot be read"));
  }));

test("a Worker that breaks down or does not end is ended, and another goes on", () =>
  on(async (page, { faults }) => {
    // Nothing else is asked then.
    await page.waitForFunction(() => document.querySelectorAll("#run-pictures img").length > 0);
    const ended = async (how) => {
      await page.workers().at(-1).evaluate(how);
      await page.click("#example");
      await page.waitForFunction(() => document.getElementById("problem").textContent.includes("started anew"));
      await page.click("#example");
      await page.waitForFunction(() => document.getElementById("verdict").textContent === "Doubtful");
    };
    const trap = () => { ready = Promise.resolve({ room() { throw new WebAssembly.RuntimeError("unreachable"); } }); };
    await ended(trap);
    assert.deepEqual(faults, []);
    await ended(() => { onmessage = () => { throw new Error("a fault of the Worker"); }; });
    faults.length = 0;
    await page.click("#example");
    await page.waitForFunction(() => document.getElementById("verdict").textContent === "Doubtful");
    // The next question, and nothing before it, finds no end.
    await page.workers().at(-1).evaluate(() => { onmessage = () => { for (;;); }; });
    await page.click("#example");
    await page.click("#stop");
    await page.waitForFunction(() => document.getElementById("problem").textContent === "Stopped.");
    await page.click("#example");
    await page.waitForFunction(() => document.getElementById("verdict").textContent === "Doubtful");
  }));

/// Numbers from 0 to 1, the same on every run.
function random(seed) {
  let state = seed;
  return () => {
    state = (state * 1664525 + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

test("files at random do no harm", () =>
  on(async (page) => {
    const count = Number(process.env.RANDOM_FILES ?? 200);
    const next = random(35);
    const whole = (most) => Math.floor(next() * most);
    const seeds = known.map(file).filter(({ bytes }) => bytes.length < 100_000);
    const verdicts = {};
    for (let n = 0; n < count; n += 1) {
      const seed = seeds[whole(seeds.length)];
      const bytes = Buffer.from(seed.bytes);
      // Noise, workbooks of noise, tables that end too early, and tables with a slip or two.
      if (n % 8 < 2) for (let k = 0; k < bytes.length; k += 1) bytes[k] = whole(256);
      if (n % 8 === 1) bytes.set([0xd0, 0xcf, 0x11, 0xe0, 0xa1, 0xb1, 0x1a, 0xe1].slice(0, bytes.length));
      for (let k = whole(4); k > 0; k -= 1) bytes[whole(bytes.length)] = n % 8 < 5 ? 48 + whole(10) : whole(256);
      const end = n % 8 === 2 ? 1 + whole(bytes.length) : bytes.length;
      await give(page, [{ name: seed.name, bytes: bytes.subarray(0, end) }]);
      const ended = (await page.textContent("#problem")).includes("started anew");
      const verdict = ended ? "ended" : await page.textContent("#verdict");
      verdicts[verdict] = (verdicts[verdict] ?? 0) + 1;
      // Noise has no COR.
      assert.ok(n % 8 >= 2 || !["Trusted", "Doubtful"].includes(verdict), `${seed.name}: ${await page.textContent("#headline")}`);
    }
    console.log(`${count} files at random:`, verdicts);
  }));

test("a table written in another way has no other COR", () =>
  on(async (page) => {
    const count = Number(process.env.ALTERED_TABLES ?? 60);
    const next = random(36);
    const whole = (most) => Math.floor(next() * most);
    const seeds = planted(join(root, "crates/saltus-fit/tests")).filter((table) => kept(table, whole) !== undefined);
    assert.ok(seeds.length > 10, `${seeds.length} tables`);
    const [verdicts, wrong] = [{}, []];
    for (let n = 0; n < count; n += 1) {
      const seed = seeds[whole(seeds.length)];
      const { ways, text } = kept(seed, whole);
      await give(page, [{ name: seed.name, bytes: Buffer.from(text) }]);
      const verdict = await page.textContent("#verdict");
      verdicts[verdict] = (verdicts[verdict] ?? 0) + 1;
      if (verdict !== "Trusted") continue;
      const { cor } = JSON.parse((await saved(page, "#save-json")).bytes);
      // Of groups each has its own.
      if (cor === null || cor === undefined) continue;
      const off = Math.abs(cor.value - seed.truth);
      if (off > Math.max(3 * cor.standard_error, seed.near)) wrong.push(`${seed.name} by ${ways}: ${cor.value}, not ${seed.truth}`);
    }
    console.log(`${count} tables written in another way:`, verdicts);
    assert.deepEqual(wrong, []);
    assert.ok(verdicts.Trusted > count / 2);
  }));
