// The runs: which one is shown, which lie over it; what is set and not yet run; saving.

import { el } from "../format";
import type { Session } from "../session";

/** Runs that stand side by side in the bar at most; on a phone fewer. */
const most = () => (matchMedia("(max-width: 820px)").matches ? 2 : 5);

export function runs(session: Session): HTMLElement {
  const list = el("div", { class: "sv-runs", role: "group", "aria-label": "runs" });
  const pending = el("div", { class: "sv-pending" });
  const draw = () => {
    list.replaceChildren(
      ...session.runs.map((run, k) => {
        const isActive = k === session.active;
        const eye = el("input", {
          type: "checkbox", checked: run.isVisible || isActive, disabled: isActive, title: "draw it over", "aria-label": `draw ${run.name} over`,
          onchange: () => {
            run.isVisible = !run.isVisible;
            session.tell("runs", "plots", "time");
          },
        });
        const name = el("button", { class: isActive ? "sv-run sv-active" : "sv-run", title: run.about || run.name, "aria-pressed": String(isActive), text: run.name, onclick: () => session.activate(k) });
        return el("span", { class: "sv-runitem" }, eye, name, run.stop ? el("span", { class: "sv-stop", title: run.stop, text: "■ stopped" }) : null);
      }),
    );
    const { length } = session.runs;
    list.hidden = length < 2 && !session.run?.stop;
    // many go into a sheet of their own
    menu.hidden = length <= most();
    (length > most() ? sheet : bar).prepend(list);
    summary.textContent = `${session.run?.name ?? ""} · ${length} runs`;
    drawPending();
  };
  const drawPending = () => {
    const { link } = session;
    pending.replaceChildren();
    if (!link) return;
    const button = (text: string, isOn: boolean, action: () => void) => el("button", { class: "sv-small", disabled: !isOn, text, onclick: action });
    const n = link.edits.length;
    const { run } = session;
    const canKeep = link.isConnected && !link.isRunning && run !== undefined && run.times.n > 1;
    const keep = button("save as result", canKeep, () => {
      session.say("saving …");
      link.send({ do: "keep", run: run.id });
    });
    keep.title = "writes this run with report, signals and figures into results/, as `sincro run` does";
    pending.append(keep);
    if (n === 0 && !link.canUndo && !link.canRedo) return;
    pending.append(
      el("span", { class: "sv-quiet", text: n === 1 ? "1 number changed" : `${n} numbers changed` }),
      button("undo", link.canUndo, () => link.undo()),
      button("redo", link.canRedo, () => link.redo()),
      button(`run from ${session.t.toFixed(3)} s`, link.hasEdits && !link.isRunning, () => link.branch(session.t)),
      button("save as scene", n > 0 && !link.isRunning, () => link.send({ do: "save", set: link.edits })),
    );
  };
  const sheet = el("div", { class: "sv-sheet sv-many" });
  const summary = el("summary", {});
  const menu = el("details", { class: "sv-menu", "data-menu": "runs" }, summary, sheet);
  const bar = el("div", { class: "sv-runbar" }, menu, pending);
  session.on("runs", draw);
  session.on("live", draw);
  session.on("playing", drawPending);
  session.on("time", () => {
    if (session.link && !session.playing && !session.link.isRunning) drawPending();
  });
  draw();
  return bar;
}
