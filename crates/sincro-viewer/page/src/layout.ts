// Where everything stands: full window, or small within a report until the reader enlarges it.

import { el } from "./format";
import { KEYS, keyboard } from "./keyboard";
import type { Session } from "./session";
import { Stage } from "./three/stage";
import { diagram } from "./ui/diagram";
import { splitters } from "./splitters";
import { properties } from "./ui/properties";
import { runs } from "./ui/runs";
import { Scopes } from "./ui/scopes";
import { shown } from "./ui/shown";
import { transport } from "./ui/transport";
import { tree } from "./ui/tree";

export function layout(root: HTMLElement, session: Session): void {
  const isEmbedded = root.classList.contains("sv-embedded");
  root.classList.add("sincro-viewer");
  if (!isEmbedded) root.classList.add("sv-full");
  const stage = new Stage(session);
  const scopes = new Scopes(session);
  const drawing = diagram(session, scopes);

  const notice = el("div", { class: "sv-notice", role: "status", hidden: true });
  let hiding = 0;
  session.on("notice", () => {
    notice.textContent = session.notice;
    notice.hidden = session.notice === "";
    clearTimeout(hiding);
    hiding = setTimeout(() => (notice.hidden = true), 12000) as unknown as number;
  });
  notice.addEventListener("click", () => (notice.hidden = true));

  const panels: [string, HTMLElement][] = [["Plots", scopes.node]];
  if (drawing) panels.push(["Diagram", drawing]);
  const tabs = el("div", { class: "sv-tabs", role: "tablist" });
  const choose = (k: number) => {
    panels.forEach(([, node], i) => (node.hidden = i !== k));
    [...tabs.children].forEach((tab, i) => tab.setAttribute("aria-selected", String(i === k)));
    scopes.rebuild();
    session.tell("time");
  };
  panels.forEach(([name], k) => tabs.append(el("button", { role: "tab", text: name, onclick: () => choose(k) })));

  const enlarge = el("button", {
    class: "sv-small sv-enlarge", text: "whole window", "aria-pressed": "false",
    onclick: () => {
      const isFull = root.classList.toggle("sv-full");
      enlarge.textContent = isFull ? "back to the report" : "whole window";
      enlarge.setAttribute("aria-pressed", String(isFull));
      document.documentElement.classList.toggle("sv-locked", isFull);
      scopes.rebuild();
      session.tell("time");
    },
  });
  const state = session.link ? el("span", { class: "sv-live", text: "live" }) : el("span", { class: "sv-live sv-replay", text: "replay" });
  session.on("live", () => {
    if (!session.link || session.link.isConnected) return;
    state.textContent = "ended";
    state.classList.add("sv-ended");
    state.title = "sincro has ended; what was recorded can still be looked at";
  });
  const header = el("header", { class: "sv-head" }, el("h2", { class: "sv-heading", text: session.film.title }), state, runs(session), shown(session, stage), isEmbedded ? enlarge : null);
  root.replaceChildren(
    header,
    tree(session),
    stage.node,
    properties(session),
    transport(session),
    el("section", { class: "sv-below" }, tabs, ...panels.map(([, node]) => node)),
    el("p", { class: "sv-keys", text: KEYS }),
    ...splitters(root, () => {
      scopes.rebuild();
      session.tell("time");
    }),
    notice,
  );
  choose(0);
  // a click beside a menu closes it
  document.addEventListener("pointerdown", (event) => {
    for (const menu of root.querySelectorAll<HTMLDetailsElement>("details.sv-menu[open]")) if (!menu.contains(event.target as Node)) menu.open = false;
  });
  keyboard(root, session, stage);
  if (session.runs.some((run) => run.isCut)) {
    session.say("There was no room for all that scripts and clients made at run time: some of it is missing here.");
  }
  if (!isEmbedded) {
    document.title = `${session.film.title} – sincro`;
    root.tabIndex = -1;
    root.focus();
  }
  loop(session, stage);
}

/** Sixty times a second: the clock, then the picture if anything has changed. */
function loop(session: Session, stage: Stage): void {
  let before = performance.now();
  const frame = (now: number) => {
    session.tick(Math.min(0.1, (now - before) / 1000));
    before = now;
    stage.draw();
    requestAnimationFrame(frame);
  };
  requestAnimationFrame(frame);
}
