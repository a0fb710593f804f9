// Drives `sincro view` in a real browser: load, play, pause, scrub, select, plot, edit, branch; and a report without a server.
// Needs CHROMIUM (default /usr/bin/chromium) and SINCRO, the program; skips with a word where there is no browser.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { clock, folder, open, options, root, scrub, sincro, started_view, state, until, view } from "./browser.mjs";

for (const [scene, object, signal, number] of [
  ["quadrotor-open-loop", "/air/quadrotor", "/air.velocity.z", "/air/quadrotor.mass"],
  ["two-dof-position", "/shoulder/elbow/forearm", "/shoulder.velocity", "/shoulder/elbow/forearm.mass"],
]) {
  test(`${scene} live: load, play, pause, scrub, select, plot, edit, branch`, options, async () => {
    const { page, wrong, first } = await open(await view(join(root, "scenes", scene)));
    console.log(`# ${scene}: first picture after ${first} ms`);
    await page.selectOption(".sv-speed", "2");
    await page.click(".sv-play");
    await until(page, () => document.querySelector(".sv-play").dataset.state === "playing");
    await until(page, () => Number.parseFloat(document.querySelector(".sv-clock").textContent) > 0.8);
    await page.keyboard.press("Space");
    await until(page, () => document.querySelector(".sv-play").dataset.state === "stopped");
    const paused = await clock(page);
    assert.ok(paused > 0.5, `paused at ${paused} s`);

    await scrub(page, 0.05);
    const back = await clock(page);
    assert.ok(back < paused, `${back} s is before ${paused} s`);
    await page.keyboard.press("ArrowRight");
    assert.ok((await clock(page)) > back || (await clock(page)) === paused, "an arrow goes one frame on");

    await page.click(`[data-path="${object}"]`);
    assert.equal(await page.locator(".sv-properties h3").innerText(), object);
    await page.fill('input[aria-label="search signals"]', signal);
    await page.click(`[data-signal="${signal}"]`);
    assert.equal(await page.locator(`[data-signal="${signal}"]`).getAttribute("aria-pressed"), "true");
    assert.ok(await page.locator(".sv-scope canvas").count() > 0, "there are plots");

    const input = page.locator(`input[aria-label="${number}"]`);
    const before = await input.inputValue();
    await input.fill(String(2 * Number(before)));
    await input.press("Enter");
    await page.click("text=undo");
    assert.equal(await page.locator(`input[aria-label="${number}"]`).inputValue(), before, "undo");
    await page.click("text=redo");
    await page.click("button:has-text('run from')");
    await until(page, () => document.querySelectorAll(".sv-run").length === 2);
    await until(page, (t) => Number.parseFloat(document.querySelector(".sv-clock").textContent) > t + 0.2, back);
    await page.click(".sv-play");
    await until(page, () => document.querySelector(".sv-play").dataset.state === "stopped");
    assert.equal(await page.locator(".sv-run.sv-active").innerText(), "run 1");

    const refused = page.locator(`input[aria-label="${number}"]`);
    await refused.fill("-1");
    await refused.press("Enter");
    await page.click("button:has-text('run from')");
    await page.waitForSelector(".sv-notice:not([hidden])");
    assert.match(await page.locator(".sv-notice").innerText(), /mass/);
    assert.deepEqual(wrong, []);
    await page.close();
  });
}

test("a finished run: the report opens without a server, and `sincro view` shows the folder", options, async () => {
  const out = join(folder, "quadrotor");
  const ran = spawnSync(sincro, ["run", join(root, "scenes/quadrotor-open-loop"), "--out", out], { encoding: "utf8" });
  assert.equal(ran.status, 0, ran.stderr);
  for (const url of [`file://${out}/report.html`, await view(out)]) {
    const { page, wrong } = await open(url);
    if (url.startsWith("file:")) await page.click("text=whole window");
    await page.click('[data-menu="runs"] summary');
    await page.click("text=lag-from-rest");
    await page.mouse.click(640, 300);
    assert.equal(await page.locator('[data-menu="runs"]').getAttribute("open"), null, "a click beside a menu closes it");
    assert.equal(await page.locator(".sv-run.sv-active").textContent(), "lag-from-rest");
    await page.locator(".sv-play").click();
    await until(page, () => Number.parseFloat(document.querySelector(".sv-clock").textContent) > 0.3);
    await page.locator(".sv-play").click();
    assert.equal(await state(page), "stopped");
    await scrub(page, 1);
    assert.equal(await clock(page), 6);
    assert.deepEqual(wrong, []);
    await page.close();
  }
});

test("a live run is saved as a result; panels are resized; live ends with the server", options, async () => {
  const child = await started_view(join(root, "scenes/two-dof-position"));
  const { page, wrong } = await open(child.url);
  for (let k = 0; k < 5; k++) await page.keyboard.press("ArrowRight");
  await until(page, () => Number.parseFloat(document.querySelector(".sv-clock").textContent) > 0.01);
  await page.click("button:has-text('save as result')");
  await until(page, () => /saved as results.two-dof-position.0001.report.html, with the same trace hash/.test(document.querySelector(".sv-notice").textContent));
  const recorded = await page.locator(".sv-signals [data-signal]").first().getAttribute("data-signal");
  assert.equal(recorded, "/shoulder.position", "what `record` names comes first");
  assert.equal(await page.locator(".sv-signal bdi").first().innerText(), recorded);

  const wide = async () => (await page.locator(".sv-objects").boundingBox()).width;
  const before = await wide();
  const grip = await page.locator('[data-border="--left"]').boundingBox();
  await page.mouse.move(grip.x + grip.width / 2, grip.y + 60);
  await page.mouse.down();
  await page.mouse.move(grip.x + 80, grip.y + 60, { steps: 4 });
  await page.mouse.up();
  assert.ok((await wide()) > before + 50, "the objects' panel is wider");

  await page.click(".sv-tabs button:has-text('Diagram')");
  const box = () => page.locator(".sv-drawing svg").getAttribute("viewBox");
  const fitted = await box();
  await page.locator(".sv-drawing").hover();
  await page.mouse.wheel(0, -300);
  const near = await box();
  assert.notEqual(near, fitted, "the wheel magnifies");
  await page.click(".sv-diagram-tools button");
  assert.equal(await box(), fitted, "fit shows all of it again");

  child.process.kill();
  await until(page, () => document.querySelector(".sv-live").textContent === "ended");
  assert.deepEqual(wrong, []);
  await page.close();
});

test("figures of a report tell values under the pointer and magnify", options, async () => {
  const out = join(folder, "spring");
  assert.equal(spawnSync(sincro, ["run", join(root, "scenes/spring-dynamic"), "--out", out]).status, 0);
  const { page, wrong } = await open(`file://${out}/report.html`);
  const plot = page.locator("figure .wide svg.sp").first();
  await plot.scrollIntoViewIfNeeded();
  const box = await plot.boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 3);
  assert.match(await page.locator(".reading").first().innerText(), /\d s\s+\/shoulder\.position\s+[−\d.]+/);
  const ticks = () => plot.evaluate((svg) => [...svg.querySelectorAll("text")].filter((t) => t.getBoundingClientRect().width > 0).map((t) => t.textContent).join());
  const whole = await ticks();
  await page.mouse.down();
  await page.mouse.move(box.x + 0.7 * box.width, box.y + box.height / 3, { steps: 5 });
  await page.mouse.up();
  assert.notEqual(await ticks(), whole);
  await plot.dblclick({ position: { x: box.width / 2, y: box.height / 3 } });
  assert.equal(await ticks(), whole);
  assert.ok((await page.locator("nav.contents a").count()) >= 5);
  assert.deepEqual(wrong, []);
  await page.close();
});

test("on a phone everything is within the width", options, async () => {
  const { page, wrong } = await open(await view(join(root, "scenes/two-dof-position")), { width: 390, height: 800 });
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= 390, `${wide} px`);
  assert.deepEqual(wrong, []);
  await page.close();
});

test("names are text, never markup", options, async () => {
  const out = join(folder, "pendulum");
  mkdirSync(out, { recursive: true });
  const evil = "<img src=x onerror=document.title='broken'></script><b>";
  writeFileSync(join(out, "scene.toml"), '[[joint]]\nname = "hinge"\nkind = "revolute"\n[[body]]\nname = "rod"\nparent = "/hinge"\nmass = 1.0\ninertia = { xx = 0.1, yy = 0.1, zz = 0.1 }\n');
  writeFileSync(join(out, "experiment.toml"), `title = "${evil}"\ndescription = "${evil}"\nduration = 0.1\nstep = 0.01\nrecord = ["/hinge.position"]\n[[plot]]\ntitle = "${evil}"\nsignals = ["/hinge.position"]\n`);
  const { page, wrong } = await open(await view(out));
  assert.equal(await page.locator(".sv-heading").innerText(), evil);
  assert.equal(await page.locator("#sincro-viewer img, #sincro-viewer b").count(), 0);
  assert.deepEqual(wrong, []);
  await page.close();
});

test("objects that a script makes are shown, live and in the replay", options, async () => {
  const scene = join(folder, "drawing");
  mkdirSync(scene);
  writeFileSync(join(scene, "experiment.toml"), 'format = 2\ntitle = "Drawing"\nscene = "scene.toml"\nduration = 1.0\nstep = 0.01\nrecord = ["/hinge.position"]\n');
  writeFileSync(join(scene, "scene.toml"), `format = 2
[[joint]]
name = "hinge"
kind = "revolute"
axis = [0.0, 1.0, 0.0]
initial = { position = 1.0 }
[[body]]
name = "arm"
parent = "/hinge"
density = 500.0
shape = [{ cuboid = { size = [0.1, 0.1, 0.5] } }]
[[script]]
object = "/hinge"
code = '''
sim = require('sim')
function sysCall_init()
    box = sim.createPrimitiveShape(sim.primitiveshape_cuboid, { 0.3, 0.3, 0.3 }, 0)
    path = sim.addDrawingObject(sim.drawing_linestrip, 2, 0, -1, 400, { 0.8, 0.1, 0.1 })
end
function sysCall_sensing()
    local t = sim.getSimulationTime()
    sim.setObjectPosition(box, { t, 0, 0 })
    sim.addDrawingObjectItem(path, { t, 0, 1 })
    if t > 0.5 and box2 == nil then box2 = sim.createPrimitiveShape(sim.primitiveshape_spheroid, { 0.2, 0.2, 0.2 }, 0) end
end
'''
`);
  const there = (page) => page.locator(".sv-stage").getAttribute("data-runtime").then(Number);
  const out = join(folder, "drawing-run");
  const run = spawnSync(sincro, ["run", scene, "--quiet", "--out", out], { encoding: "utf8" });
  assert.equal(run.status, 0, run.stderr);
  const { page, wrong } = await open(await view(out));
  await page.keyboard.press("Home");
  assert.equal(await there(page), 2, "a box and a path at the start");
  await page.keyboard.press("End");
  assert.equal(await there(page), 3, "a ball too at the end");
  await page.keyboard.press("Home");
  assert.equal(await there(page), 2, "and back");
  assert.deepEqual(wrong, []);
  await page.close();
  const live = await open(await view(scene));
  await live.page.click(".sv-play");
  await until(live.page, () => document.querySelector(".sv-stage").dataset.runtime === "3");
  assert.deepEqual(live.wrong, []);
  await live.page.close();
});
