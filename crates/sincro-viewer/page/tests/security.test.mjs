// Attacks by web pages, in a real browser: a sandboxed frame, a page of another site, a name that was pointed at this machine, cross-site forms
// and requests. None of them may open a line, start a simulation or read anything; the same page with the token may.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { createServer } from "node:http";
import { join } from "node:path";
import { test } from "node:test";
import { launch, options, root, sincro, started, view } from "./browser.mjs";

/** `sincro serve` on free ports: its addresses, as it prints them. */
async function serve() {
  const free = ["--legacy-port", "0", "--zmq-port", "0", "--ws-port", "0", "--record", "none"];
  const server = started(spawn(sincro, ["serve", join(root, "scenes/two-dof-remote"), ...free], { stdio: ["ignore", "pipe", "inherit"] }));
  let said = "";
  await new Promise((done) => {
    server.stdout.on("data", (data) => {
      said += data;
      if (said.includes("Ctrl-C ends")) done();
    });
  });
  const port = (pattern) => Number(said.match(pattern)[1]);
  return {
    legacy: port(/legacy remote API\s+127\.0\.0\.1:(\d+)/),
    zmq: port(/ZeroMQ remote API\s+127\.0\.0\.1:(\d+)/),
    steps: port(/step counter 127\.0\.0\.1:(\d+)/),
    ws: port(/WebSocket\s+127\.0\.0\.1:(\d+)/),
    link: said.match(/(ws:\/\/127\.0\.0\.1:\d+\/\?token=[0-9a-f]{32})/)[1],
    says: () => said,
  };
}

/** Tries to open a WebSocket and to start a simulation over it, in the page. */
const line = `
  function line(url) {
    return new Promise((done) => {
      const socket = new WebSocket(url);
      socket.onopen = () => socket.send('{"func":"sim.startSimulation"}');
      socket.onmessage = () => done("open");
      socket.onerror = socket.onclose = () => done("refused");
    });
  }`;

test("pages without the token neither read nor drive anything", options, async () => {
  const ports = await serve();
  const shown = await view(join(root, "scenes/two-dof-remote"));
  const viewer = new URL(shown);
  const pages = createServer((_, response) => response.writeHead(200, { "content-type": "text/html" }).end(`<!doctype html><script>${line}</script>`));
  await new Promise((done) => pages.listen(0, "127.0.0.1", done));
  const browser = await launch(["--host-resolver-rules=MAP evil.test 127.0.0.1"]);
  try {
    const page = await browser.newPage();
    await page.goto(`http://evil.test:${pages.address().port}/`);
    const targets = [`ws://127.0.0.1:${ports.ws}`, `ws://localhost:${ports.ws}`, `ws://evil.test:${ports.ws}`].concat(
      ["127.0.0.1", "localhost", "evil.test"].map((host) => `ws://${host}:${viewer.port}/live`),
    );
    for (const url of targets) {
      assert.equal(await page.evaluate((url) => line(url), url), "refused", `another site: ${url}`);
      // the frame's origin is "null", as that of a page from disk is in some browsers
      const framed = await page.evaluate(
        ([url, line]) =>
          new Promise((done) => {
            const frame = document.createElement("iframe");
            frame.sandbox = "allow-scripts";
            frame.srcdoc = `<script>${line}; line(${JSON.stringify(url)}).then((x) => parent.postMessage(x, "*"))<\/script>`;
            addEventListener("message", ({ data }) => done(data), { once: true });
            document.body.append(frame);
          }),
        [url, line],
      );
      assert.equal(framed, "refused", `a sandboxed frame: ${url}`);
    }
    // a name that was pointed here, the token known or not: the host gives it away
    for (const query of ["", viewer.search, new URL(ports.link).search]) {
      assert.equal(await page.evaluate((url) => line(url), `ws://evil.test:${viewer.port}/live${query}`), "refused");
      assert.equal(await page.evaluate((url) => line(url), `ws://evil.test:${ports.ws}/${query}`), "refused");
    }
    const all = [ports.legacy, ports.zmq, ports.steps, ports.ws, Number(viewer.port)];
    const answers = await page.evaluate(async (all) => {
      const answers = [];
      for (const port of all)
        for (const host of ["127.0.0.1", "evil.test"])
          for (const mode of ["cors", "no-cors"]) {
            const body = '{"func":"sim.startSimulation"}';
            const asked = fetch(`http://${host}:${port}/film.json`, { method: "POST", mode, body });
            answers.push(await asked.then((answer) => (answer.type === "opaque" ? "opaque" : answer.text()), () => "failed"));
            const read = fetch(`http://${host}:${port}/`, { mode });
            answers.push(await read.then((answer) => (answer.type === "opaque" ? "opaque" : answer.text()), () => "failed"));
          }
      return answers;
    }, all);
    assert.ok(answers.length === 40 && answers.every((text) => !/sincro-viewer|joint|success/.test(text)), answers.join(" | "));
    // forms that post themselves into frames
    await page.evaluate(async (all) => {
      for (const port of all) {
        const frame = Object.assign(document.createElement("iframe"), { name: `f${port}` });
        const form = Object.assign(document.createElement("form"), { method: "post", action: `http://127.0.0.1:${port}/`, target: frame.name, enctype: "text/plain" });
        form.append(Object.assign(document.createElement("input"), { name: '{"func":"sim.startSimulation","x":"', value: '"}' }));
        document.body.append(frame, form);
        form.submit();
        await new Promise((done) => setTimeout(done, 100));
      }
    }, all);
    // a page of another site may not put the viewer's page into a frame of its own (clickjacking)
    await page.evaluate((url) => document.body.append(Object.assign(document.createElement("iframe"), { src: url, id: "inside" })), shown);
    await page.waitForTimeout(500);
    const inside = page.frames().find((frame) => frame.url().startsWith("http://127.0.0.1") && frame.url().includes(viewer.port));
    assert.ok(!inside || (await inside.locator("#sincro-viewer").count().catch(() => 0)) === 0, "the viewer is in a frame of another site");

    // nothing has happened, and whoever has the token may come in from wherever the page stands
    const state = await page.evaluate(
      (link) =>
        new Promise((done, failed) => {
          const socket = new WebSocket(link);
          socket.onopen = () => socket.send('{"func":"sim.getSimulationState"}');
          socket.onmessage = ({ data }) => done(JSON.parse(data).ret[0]);
          socket.onerror = () => failed(new Error("refused with the token"));
        }),
      ports.link,
    );
    assert.equal(state, 0, "a simulation was started");
    assert.doesNotMatch(ports.says(), /run 1/);
  } finally {
    await browser.close();
    pages.close();
  }
});

test("the viewer's page wants the token of its link", options, async () => {
  const browser = await launch([]);
  try {
    const page = await browser.newPage();
    const shown = new URL(await view(join(root, "scenes/motor-step")));
    for (const query of ["", "?token=", "?token=0123456789abcdef0123456789abcdef", "?ticket=0"]) {
      const answer = await page.goto(`${shown.origin}/${query}`);
      assert.equal(answer.status(), 403, query);
    }
    assert.equal((await page.goto(shown.href)).status(), 200);
    await page.waitForSelector(".sv-stage[data-drawn]");
  } finally {
    await browser.close();
  }
});
