// How the page looks: readable by everyone, on every width, in light and dark.
import assert from "node:assert/strict";
import { createRequire } from "node:module";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { on, pictures, start, stop } from "./browser.mjs";

before(() => start());
after(stop);

const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");

for (const width of [1280, 375]) {
  for (const colorScheme of ["light", "dark"]) {
    test(`${width} px, ${colorScheme}: no violation, nothing cut off`, () =>
      on(async (page) => {
        // A page's own policy does not hold for what the browser itself runs in it.
        const session = await page.context().newCDPSession(page);
        await session.send("Runtime.evaluate", { expression: axe });
        for (const name of ["measure", "play", "compare"]) {
          await page.click(`#tab-${name}`);
          if (name === "play") {
            await page.click("#effects");
            await page.waitForSelector("#effects-table table");
          }
          await page.waitForTimeout(150);
          const run = `axe.run(document, { resultTypes: ["violations"] }).then((found) => JSON.stringify(found.violations.map((v) => [v.id, v.nodes.map((n) => n.html.slice(0, 200) + n.failureSummary)])))`;
          const { result } = await session.send("Runtime.evaluate", { expression: run, awaitPromise: true });
          assert.deepEqual(JSON.parse(result.value), [], name);
          const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
          assert.ok(wide <= 0, `${name} is ${wide} px too wide`);
          await page.screenshot({ path: join(pictures, `${name}-${width}-${colorScheme}.png`), fullPage: true });
        }
      }, { viewport: { width, height: 900 }, colorScheme, reducedMotion: "reduce" }));
  }
}
