// Play and Compare: sliders, text, the player, files.
import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { html, on, root, saved, start, stop } from "./browser.mjs";

before(() => start());
after(stop);

const scenes = readdirSync(join(root, "examples/scenes")).filter((name) => name.endsWith(".toml"));
const ran = (page) => page.waitForFunction(() => document.querySelectorAll("#run-pictures img").length > 0 && document.getElementById("scene-problem").hidden);
const tab = (page, name) => page.click(`#tab-${name}`);

/// Sets a slider as a hand does; the milliseconds until its answer is on the page.
async function slide(page, name, value) {
  await page.evaluate(() => { delete document.getElementById("play").dataset.took; });
  await page.locator(`#knob-${name}`).evaluate((slider, to) => {
    slider.value = to;
    slider.dispatchEvent(new Event("input", { bubbles: true }));
  }, value);
  const took = await page.waitForFunction(() => document.getElementById("play").dataset.took ?? (document.getElementById("scene-problem").hidden ? false : "refused"));
  const text = await took.jsonValue();
  assert.notEqual(text, "refused", `${name} = ${value}: ${await page.textContent("#scene-problem")}`);
  return Number(text);
}

test("sliders of every example scene answer; the least times from hand to page", () =>
  on(async (page) => {
    await tab(page, "play");
    const names = await page.locator("#scenes option").evaluateAll((options) => options.map((option) => option.value));
    assert.equal(names.length, scenes.length + 1);
    for (const scene of names) {
      await page.selectOption("#scenes", scene);
      await ran(page);
      await page.waitForTimeout(50);
      const before = await page.inputValue("#toml");
      const moved = [];
      for (const name of ["drop", "cor", "gravity", "drag", "spin", "slope"]) {
        const slider = page.locator(`#knob-${name}`);
        if (await slider.isDisabled()) continue;
        const at = Number(await slider.inputValue());
        const times = [];
        for (const part of [0.95, 0.9, 0.85, 0.95, 1]) times.push(await slide(page, name, at === 0 ? 0.1 * (1 - part) : part * at));
        moved.push(`${name} ${Math.min(...times).toFixed(1)}`);
      }
      console.log(`${scene}: ${moved.join(", ")} ms`);
      assert.ok(moved.length >= 2, `${scene} has ${moved.length} sliders`);
      const comments = (text) => text.match(/#.*/g) ?? [];
      assert.deepEqual(comments(await page.inputValue("#toml")), comments(before), scene);
    }
  }));

test("a slider writes the scene that the tool would read", () =>
  on(async (page) => {
    await tab(page, "play");
    await ran(page);
    await slide(page, "drop", 2.5);
    await slide(page, "cor", 0.5);
    await slide(page, "slope", 10);
    const text = await page.inputValue("#toml");
    for (const line of ['height = "2.5 m"', "restitution = 0.5", 'angle = "10 deg"', "# from x towards up is positive"]) assert.ok(text.includes(line), text);
    await page.selectOption("#planets", { index: 4 });
    await page.waitForFunction(() => document.getElementById("toml").value.includes('gravity = "1.6'));
  }));

test("text runs as it is written, and a mistake is shown at its place", () =>
  on(async (page) => {
    await tab(page, "play");
    await page.fill("#toml", "restitution = 1.2\nball = { height = '1 m' }\n");
    await page.waitForSelector("#toml[aria-invalid]");
    assert.match(await page.textContent("#scene-problem"), /scene:1:15: 1\.2 is not a coefficient of restitution[\s\S]*\^\^\^/);
    await page.fill("#toml", "restitution = 0.2\nball = { height = '1 m' }\n");
    await ran(page);
    assert.equal(await page.locator("#knob-spin").isDisabled(), true);
    assert.equal(Number(await page.inputValue("#knob-cor")), 0.2);
  }));

test("the picture moves, pauses, and goes frame by frame by keyboard", () =>
  on(async (page) => {
    await tab(page, "play");
    await ran(page);
    const clock = () => page.textContent("#stage .clock");
    await page.focus("#stage canvas");
    await page.keyboard.press("Home");
    assert.match(await clock(), /^0\.000 s of 4\.000 s; tennis ball: 1\.000 m$/);
    await page.keyboard.press("ArrowRight");
    assert.match(await clock(), /^0\.017 s/);
    await page.keyboard.press("Space");
    await page.waitForFunction(() => parseFloat(document.querySelector("#stage .clock").textContent) > 0.2);
    await page.keyboard.press("Space");
    const there = await clock();
    await page.waitForTimeout(100);
    assert.equal(await clock(), there);
    await page.keyboard.press("End");
    assert.match(await clock(), /^4\.000 s of 4\.000 s/);
  }));

test("with reduced motion nothing moves by itself", () =>
  on(async (page) => {
    await tab(page, "play");
    await page.selectOption("#scenes", "topspin");
    await ran(page);
    await page.waitForTimeout(200);
    assert.match(await page.textContent("#stage .clock"), /^0\.000 s/);
  }, { reducedMotion: "reduce" }));

test("motions are saved for animators", () =>
  on(async (page) => {
    await tab(page, "play");
    await page.selectOption("#scenes", "topspin");
    await ran(page);
    const glb = await saved(page, '[data-export="glb"]');
    assert.deepEqual([glb.name, String(glb.bytes.subarray(0, 4))], ["ball.glb", "glTF"]);
    assert.match(await page.textContent("#said"), /keys/);
    assert.ok(JSON.parse((await saved(page, '[data-export="lottie"]')).bytes).layers.length > 0);
    assert.match(String((await saved(page, '[data-export="svg"]')).bytes), /^<svg|^<\?xml/);
    const toml = await saved(page, "#save-toml");
    const example = readFileSync(join(root, "examples/scenes/topspin.toml"), "utf8").replace(/^#:schema.*\n/, "");
    assert.equal(String(toml.bytes), example);
  }));

test("each effect is tried", () =>
  on(async (page) => {
    await tab(page, "play");
    await page.selectOption("#scenes", "topspin");
    await ran(page);
    await page.click("#effects");
    await page.waitForSelector("#effects-table table");
    const rows = await page.locator("#effects-table tbody tr").allTextContents();
    assert.equal(rows.length, 10);
    assert.ok(rows.some((row) => row.startsWith("without quadratic drag")), rows.join("\n"));
  }));

test("a link shares the scene", () =>
  on(async (page) => {
    await tab(page, "play");
    await ran(page);
    await slide(page, "cor", 0.31);
    await page.click("#link");
    const url = page.url();
    assert.match(url, /#scene=/);
    await on(async (other) => {
      await ran(other);
      assert.equal(await other.isVisible("#play"), true);
      assert.equal(await other.inputValue("#toml"), await page.inputValue("#toml"));
    }, { url });
    const evil = new URLSearchParams({ scene: "<img src=x onerror=document.title=1>" });
    await on(async (other) => {
      await other.waitForSelector("#toml[aria-invalid]");
      assert.equal(await other.locator("img[src=x]").count(), 0);
    }, { url: `${pathToFileURL(html).href}#${evil}` });
  }));

test("the fitted ball is played, and stands beside its readings", () =>
  on(async (page) => {
    await page.click("#compare-fit");
    const clock = () => page.textContent("#beside .clock");
    await page.focus("#beside canvas");
    await page.keyboard.press("End");
    assert.match(await clock(), /contact 3: read 0\.00 mm at 1\.110 s$/);
    await page.keyboard.press("Home");
    assert.match(await clock(), /^0\.000 s .*; fitted: 1\.000 m; release: read 1\.000 m/);
    await tab(page, "measure");
    await page.click("#play-fit");
    await ran(page);
    assert.match(await page.inputValue("#toml"), /restitution = /);
  }));
