// What the tests of the page share: a browser, `sincro view` as a child process, a page that notes what goes wrong in it.
import { spawn } from "node:child_process";
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { after, before } from "node:test";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

export const root = resolve(dirname(fileURLToPath(import.meta.url)), "../../../..");
const executablePath = process.env.CHROMIUM ?? "/usr/bin/chromium";
export const sincro = process.env.SINCRO ?? join(root, "target/release/sincro");
const skip = existsSync(executablePath) ? false : `there is no browser at ${executablePath}`;
export const options = { skip, timeout: 120_000 };

let browser;
const children = [];
export const folder = mkdtempSync(join(tmpdir(), "sincro-viewer-"));

/** A browser with further arguments; who starts it closes it. */
export const launch = (more) =>
  chromium.launch({ executablePath, args: ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", ...more] });

before(async () => {
  if (!skip) browser = await launch([]);
});

after(async () => {
  await browser?.close();
  for (const child of children) child.kill();
  rmSync(folder, { recursive: true, force: true });
});

/** A child process that is ended with the tests. */
export function started(child) {
  children.push(child);
  return child;
}

/** An empty page. */
export const blank = (viewport) => browser.newPage({ viewport });

/** Starts `sincro view` and waits for its address. */
export async function view(what, ...more) {
  return (await started_view(what, ...more)).url;
}

/** As `view`, with the process. */
export async function started_view(what, ...more) {
  const child = started(spawn(sincro, ["view", what, "--no-browser", ...more], { cwd: folder, stdio: ["ignore", "pipe", "inherit"] }));
  const url = await new Promise((done, failed) => {
    child.stdout.once("data", (data) => done(String(data).trim()));
    child.once("exit", (code) => failed(new Error(`sincro view ended with ${code}`)));
  });
  return { url, process: child };
}

/** A page that notes what goes wrong in it. */
export async function open(url, size = { width: 1280, height: 720 }) {
  const page = await browser.newPage({ viewport: size });
  const wrong = [];
  page.on("console", (message) => message.type() === "error" && wrong.push(message.text()));
  page.on("pageerror", (error) => wrong.push(error.message));
  // while working on the page: the bundle on disk in place of the one in the program
  if (process.env.BUNDLE) for (const file of ["viewer.js", "viewer.css"]) await page.route(`**/${file}`, (route) => route.fulfill({ path: join(process.env.BUNDLE, file) }));
  const begin = Date.now();
  await page.goto(url);
  await page.waitForSelector(".sv-stage[data-drawn]");
  return { page, wrong, first: Date.now() - begin };
}

export const clock = (page) => page.locator(".sv-clock").innerText().then((text) => Number.parseFloat(text));
export const state = (page) => page.locator(".sv-play").getAttribute("data-state");
export const until = (page, what, ...more) => page.waitForFunction(what, ...more, { timeout: 60_000 });

export async function scrub(page, share) {
  await page.locator(".sv-timeline").evaluate((slider, value) => {
    slider.value = String(1000 * value);
    slider.dispatchEvent(new Event("input"));
  }, share);
}
