// What a scene shows in the browser: contact, closures, cameras, joints to be placed, bodies to be pulled, wires to be plotted, plots to be saved, files to be written.
import assert from "node:assert/strict";
import { cpSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { clock, folder, open, options, root, scrub, state, until, view } from "./browser.mjs";

const scene = (name) => join(root, "scenes", name);
const legend = (page) => page.locator(".sv-legend").innerText();

/** Plays until the clock shows `t`, then stands still. */
async function playTo(page, t) {
  await page.click(".sv-play");
  await until(page, (to) => Number.parseFloat(document.querySelector(".sv-clock").textContent) >= to, t);
  if ((await state(page)) === "playing") await page.click(".sv-play");
  await until(page, () => document.querySelector(".sv-play").dataset.state === "stopped");
}

test("contact: points, forces and their sum; the scene's camera comes first", options, async () => {
  const { page, wrong } = await open(await view(scene("gripper")));
  assert.equal(await page.locator(".sv-menu select").inputValue(), "/front");
  await playTo(page, 0.2);
  assert.match(await legend(page), /contact force, largest now [\d.]+ N/);
  await page.click('[data-path="/left/pad"]');
  assert.match(await page.locator(".sv-now").innerText(), /contact force\s+−20\.00/);
  assert.match(await page.locator(".sv-numbers").innerText(), /contact\.friction/);
  await page.click('[data-menu="view"] summary');
  const [picture] = await Promise.all([page.waitForEvent("download"), page.click("text=save the picture")]);
  const content = readFileSync(await picture.path());
  assert.ok(content.subarray(1, 4).toString() === "PNG" && content.length > 5000, "the picture is one");
  await page.uncheck('[data-shown="contactForces"]');
  assert.doesNotMatch(await legend(page), /contact force/);
  assert.ok(await page.locator('[data-toggle="contactForces"]').isVisible(), "a switch for what there is");
  assert.equal(await page.locator('[data-toggle="wind"]').isVisible(), false, "none for what there is not");
  await page.keyboard.press("2");
  assert.match(await page.locator(".sv-menu select").inputValue(), /^front \(along y\)/);
  await page.keyboard.press("5");
  assert.equal(await page.locator(".sv-menu select").inputValue(), "/front");
  assert.deepEqual(wrong, []);
  await page.close();
});

test("closures stand in the tree, with their opening; wind and drag have arrows", options, async () => {
  const one = await open(await view(scene("four-bar")));
  await one.page.click('[data-path="/pin1"]');
  assert.match(await one.page.locator(".sv-now").innerText(), /hinge closure[\s\S]*opening\s+0\s+m/);
  const two = await open(await view(scene("quadrotor-wind")));
  await playTo(two.page, 0.5);
  const words = await legend(two.page);
  for (const what of ["thrust", "drag", "wind"]) assert.match(words, new RegExp(`${what}, largest now [\\d.]+ (N|m/s)`));
  await two.page.click('[data-path="/air/quadrotor/hull"]');
  assert.match(await two.page.locator(".sv-properties").innerText(), /area\.0\s+m²/);
  assert.deepEqual([...one.wrong, ...two.wrong], []);
  await one.page.close();
  await two.page.close();
});

test("a joint is placed by its slider, and a body is pulled by the mouse", options, async () => {
  const { page, wrong } = await open(await view(scene("double-pendulum")));
  const joint = await page.locator(".sv-tree li").first().getAttribute("data-path");
  await page.click(`[data-path="${joint}"]`);
  await page.locator(`input[aria-label="place ${joint}"]`).evaluate((slider) => {
    slider.value = "0.5";
    slider.dispatchEvent(new Event("change"));
  });
  await until(page, () => document.querySelectorAll(".sv-run").length === 2);
  await until(page, () => /coordinate\s+0\.50/.test(document.querySelector(".sv-now").innerText));
  // where there is a body: the page's own title of the picture says so
  const box = await page.locator(".sv-stage").boundingBox();
  let found = null;
  for (let k = 0; k < 900 && !found; k++) {
    const [x, y] = [box.x + box.width * (0.2 + (0.6 * (k % 30)) / 30), box.y + box.height * (0.05 + (0.9 * Math.floor(k / 30)) / 30)];
    await page.mouse.move(x, y);
    if (await page.locator(".sv-stage canvas").getAttribute("title")) found = [x, y];
  }
  assert.ok(found, "there is a body under the mouse somewhere");
  await page.selectOption(".sv-speed", "0.05");
  await page.keyboard.press("Space");
  await until(page, () => document.querySelector(".sv-play").dataset.state === "playing");
  await page.keyboard.down("Control");
  await page.mouse.down();
  await page.mouse.move(found[0] + 60, found[1] - 40, { steps: 5 });
  await page.waitForSelector(".sv-push:not([hidden])");
  assert.match(await page.locator(".sv-push").innerText(), /^[\d.]+ N$/);
  await page.mouse.up();
  await page.keyboard.up("Control");
  assert.equal(await page.locator(".sv-push").isHidden(), true);
  assert.deepEqual(wrong, []);
  await page.close();
});

test("a click on a wire plots it, and plots are saved as numbers and pictures", options, async () => {
  const { page, wrong } = await open(await view(scene("two-dof-position")));
  await playTo(page, 0.3);
  const before = await page.locator(".sv-scope").count();
  await page.click(".sv-tabs button:has-text('Diagram')");
  await page.waitForSelector("g.sv-recorded-wire");
  const carried = await page.locator(".sv-carried").allTextContents();
  assert.ok(carried.some((text) => /\d/.test(text)), "wires say what they carry");
  for (const wire of await page.locator("g.sv-recorded-wire").all()) await wire.dispatchEvent("click");
  await page.click(".sv-tabs button:has-text('Plots')");
  const pressed = await page.locator('.sv-signal[aria-pressed="true"]').count();
  assert.ok((await page.locator(".sv-scope").count()) > before || pressed > before, "a plot or a line has come");
  for (const [kind, begin] of [["CSV", "t [s],"], ["SVG", "<svg"], ["PNG", "\u0089PNG"]]) {
    const [download] = await Promise.all([page.waitForEvent("download"), page.locator(`.sv-scope button:text-is("${kind}")`).first().click()]);
    const content = readFileSync(await download.path(), "latin1");
    assert.ok(content.startsWith(begin), `${kind}: ${content.slice(0, 30)}`);
  }
  assert.deepEqual(wrong, []);
  await page.close();
});

test("save as scene: the number changes, comments stay; restart makes a new run", options, async () => {
  const copy = join(folder, "arm");
  cpSync(scene("two-dof-open-loop"), copy, { recursive: true });
  const { page, wrong } = await open(await view(copy));
  const body = await page.locator('.sv-tree li[title$=": body"]').first().getAttribute("data-path");
  await page.click(`[data-path="${body}"]`);
  const input = page.locator(".sv-numbers input").first();
  const path = await input.getAttribute("aria-label");
  const old = await input.inputValue();
  await input.fill(String(1.5 * Number(old)));
  await input.press("Enter");
  await page.click("text=save as scene");
  await page.waitForSelector(".sv-notice:not([hidden])");
  assert.match(await page.locator(".sv-notice").innerText(), /saved as .*arm-edited/);
  const [was, is] = [copy, `${copy}-edited`].map((where) => readFileSync(join(where, "scene.toml"), "utf8"));
  assert.equal(was, readFileSync(join(scene("two-dof-open-loop"), "scene.toml"), "utf8"), "the scene itself is as it was");
  assert.equal(is.length - was.length, String(1.5 * Number(old)).length - was.slice(differs(was, is)).match(/^[\d.e+-]*/)[0].length, path);
  assert.equal(is.split("\n").filter((line) => line.includes("#")).length, was.split("\n").filter((line) => line.includes("#")).length, "comments stay");

  await page.click("text=undo");
  await playTo(page, 0.2);
  await page.keyboard.press("Home");
  assert.equal(await clock(page), 0);
  await page.click('[aria-label="back to the start (home)"]');
  await until(page, () => document.querySelectorAll(".sv-run").length === 2);
  await playTo(page, 0.1);
  await scrub(page, 0);
  assert.match(await page.locator(".sv-scope .u-legend").first().innerText(), /· main/, "the run before lies over it");
  assert.deepEqual(wrong, []);
  await page.close();
});

/** Where two texts part. */
function differs(a, b) {
  let k = 0;
  while (a[k] === b[k]) k++;
  while (/[\d.]/.test(a[k - 1] ?? "")) k--;
  return k;
}
