// The page in a real browser, from a disk: every test opens its own.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync } from "node:fs";
import { basename, dirname, join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

export const root = join(import.meta.dirname, "../..");
const target = process.env.CARGO_TARGET_DIR ?? join(root, "target");
export const html = process.env.SALTUS_HTML ?? join(target, "saltus.html");
const tool = resolve(process.env.SALTUS_TOOL ?? join(target, "debug/saltus"));
export const pictures = join(target, "web-pictures");
mkdirSync(pictures, { recursive: true });

let browser;
export async function start(...flags) {
  const known = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"];
  const path = process.env.CHROMIUM ?? execFileSync("sh", ["-c", `ls ${known.join(" ")} 2>/dev/null | head -1`], { encoding: "utf8" }).trim();
  // Pictures are of the same pixels everywhere; nothing needs a sandbox that containers do not have.
  browser = await chromium.launch({ executablePath: path, args: ["--no-sandbox", "--force-color-profile=srgb", ...flags] });
}
export const stop = () => browser.close();

/// A page with its faults and requests; closed, and asked for faults, when `act` is done.
export async function on(act, { url = pathToFileURL(html).href, ready = true, ...options } = {}) {
  const context = await browser.newContext({ acceptDownloads: true, offline: true, ...options });
  const page = await context.newPage();
  const [faults, requests] = [[], []];
  page.on("pageerror", (error) => faults.push(String(error)));
  page.on("console", (message) => message.type() === "error" && faults.push(message.text()));
  page.on("dialog", (dialog) => { faults.push(`dialog: ${dialog.message()}`); dialog.dismiss(); });
  page.on("request", (request) => requests.push(request.url()));
  try {
    await page.goto(url);
    if (ready) await page.waitForSelector("html[data-ready]");
    await act(page, { faults, requests });
    assert.deepEqual(faults, [], "faults in the console");
    const elsewhere = requests.filter((address) => !/^(file|blob|data):/.test(address) && address !== url && new URL(address).origin !== new URL(url).origin);
    assert.deepEqual(elsewhere, [], "requests that leave");
  } finally {
    await context.close();
  }
}

/// Gives the page files `{ name, bytes }`, and waits for its answer; what it was asked before is
/// answered first, for that answer would be taken for this one.
export async function give(page, files) {
  await page.waitForFunction(() => document.getElementById("result").getAttribute("aria-busy") === "false");
  await page.evaluate(() => { document.getElementById("said").textContent = ""; });
  await page.setInputFiles("#files", files.map(({ name, bytes }) => ({ name, mimeType: "", buffer: Buffer.from(bytes) })));
  await page.waitForFunction(() => document.getElementById("said").textContent !== "" && document.getElementById("result").getAttribute("aria-busy") === "false");
}

/// What a button gives to be saved: its name and bytes. Chromium now and then begins no download
/// for a click, and does for the next: faults of the page itself are asked for at its end.
export async function saved(page, button, tries = 3) {
  const begun = page.waitForEvent("download", { timeout: 10_000 }).catch((error) => error);
  await page.click(button);
  const download = await begun;
  if (download instanceof Error) {
    if (tries > 1) return saved(page, button, tries - 1);
    throw download;
  }
  const parts = [];
  for await (const part of await download.createReadStream()) parts.push(part);
  return { name: download.suggestedFilename(), bytes: Buffer.concat(parts) };
}

/// The tool's JSON of files in a folder, or its error.
export function fitted(paths, ...options) {
  try {
    return JSON.parse(execFileSync(tool, ["fit", "-q", ...paths.map((path) => basename(path)), "--format", "json", ...options], { cwd: dirname(paths[0]), encoding: "utf8", stdio: ["ignore", "pipe", "ignore"], maxBuffer: 1e9 }));
  } catch (error) {
    if (error.status !== 2) throw error;
    return JSON.parse(error.stdout);
  }
}

/// The tool's report of a file for people.
export const told = (path) => execFileSync(tool, ["fit", "-q", basename(path)], { cwd: dirname(path), encoding: "utf8" }).trim();

/// Sums of squares and probabilities below this are what is left of rounding.
const ROUNDING = 1e-20;

/// How near numbers are that are the same, as a part of themselves.
const SAME = 1e-9;

/// Asserts that two documents are alike, numbers to a part of themselves.
export function alike(got, wanted, within = SAME, place = "") {
  if (typeof got === "number" && typeof wanted === "number") {
    const near = Math.abs(got - wanted) <= Math.max(ROUNDING, within * Math.max(Math.abs(got), Math.abs(wanted)));
    assert.ok(near, `${place}: ${got} is not ${wanted}`);
  } else if (got !== null && wanted !== null && typeof got === "object" && typeof wanted === "object") {
    assert.deepEqual(Object.keys(got), Object.keys(wanted), `keys of ${place}`);
    for (const key of Object.keys(got)) alike(got[key], wanted[key], within, `${place}/${key}`);
  } else assert.equal(got, wanted, place);
}
