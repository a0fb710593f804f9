// The remote API's example in a browser: the run that it makes is the one of `sincro run`.
import assert from "node:assert/strict";
import { spawn, spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { pathToFileURL } from "node:url";
import { blank, folder, options, root, sincro, started } from "./browser.mjs";

test("a page drives a scene over WebSocket", options, async () => {
  const scene = join(root, "scenes/two-dof-remote");
  const [alone, served] = [join(folder, "alone"), join(folder, "served")];
  assert.equal(spawnSync(sincro, ["run", scene, "--out", alone]).status, 0);
  const { trace_hash: expected } = JSON.parse(readFileSync(join(alone, "run.json"), "utf8"));

  const server = started(spawn(sincro, ["serve", scene, "--legacy-port", "0", "--zmq-port", "0", "--ws-port", "0", "--out", served], { stdio: ["ignore", "pipe", "inherit"] }));
  let said = "";
  const says = (pattern) =>
    new Promise((found) => {
      const look = () => pattern.test(said) && found(said.match(pattern)[1]);
      server.stdout.on("data", look);
      look();
    });
  server.stdout.on("data", (data) => (said += data));
  const link = await says(/(ws:\/\/127\.0\.0\.1:\d+\/\?token=[0-9a-f]{32})/);

  const page = await blank({ width: 900, height: 640 });
  const wrong = [];
  page.on("pageerror", (error) => wrong.push(error.message));
  const example = pathToFileURL(join(root, "examples/clients/browser/two_dof.html"));
  // a page from disk is nobody's page: without the token it is refused, and says what to do
  await page.goto(`${example}#server=${link.split("/?")[0]}`);
  await page.getByRole("button", { name: "Run" }).click();
  await page.waitForFunction(() => document.getElementById("says").textContent.includes("link that it prints"));
  await page.goto("about:blank");
  await page.goto(`${example}#server=${link}`);
  await page.getByRole("button", { name: "Run" }).click();
  assert.equal(await says(/run 1 ended .* trace (\w+)/), expected);
  await page.waitForFunction(() => document.getElementById("says").textContent.startsWith("6 s: 0.99976"));
  if (process.env.PICTURE) await page.screenshot({ path: process.env.PICTURE });

  // without a server it says so
  await new Promise((ended) => {
    server.once("exit", ended);
    server.kill();
  });
  await page.getByRole("button", { name: "Run" }).click();
  await page.waitForFunction(() => document.getElementById("says").textContent.includes("`sincro serve SCENE`"));
  assert.deepEqual(wrong, []);
  await page.close();
});
