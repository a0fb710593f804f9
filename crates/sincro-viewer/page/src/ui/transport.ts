// Transport: play, pause, step, speed, the timeline with everything recorded, the real-time factor.

import { el, format } from "../format";
import type { Session } from "../session";

const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 5, 10];

const PLAY = "M4 2.5v11l9-5.5z";
const PAUSE = "M3.5 3h3.4v10H3.5zM9.1 3h3.4v10H9.1z";

/** A picture in a button; drawn, because fonts lack such signs. */
function icon(button: HTMLElement, shape: string): void {
  if (button.dataset["icon"] === shape) return;
  button.dataset["icon"] = shape;
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  svg.setAttribute("viewBox", "0 0 16 16");
  svg.setAttribute("aria-hidden", "true");
  path.setAttribute("d", shape);
  svg.append(path);
  button.replaceChildren(svg);
}

export function transport(session: Session): HTMLElement {
  const button = (label: string, shape: string, action: () => void) => {
    const made = el("button", { class: "sv-button", title: label, "aria-label": label, onclick: action });
    icon(made, shape);
    return made;
  };
  const play = button("play (space)", PLAY, () => session.togglePlay());
  play.classList.add("sv-play");
  const slider = el("input", {
    type: "range", class: "sv-timeline", min: "0", max: "1000", step: "1", value: "0", "aria-label": "time",
    oninput: () => {
      session.playing = false;
      session.seek((Number(slider.value) / 1000) * session.end);
      session.tell("playing");
    },
  });
  const recorded = el("div", { class: "sv-recorded" });
  const clock = el("output", { class: "sv-clock", "aria-live": "off" });
  const factor = el("span", { class: "sv-factor" });
  const speed = el("select", {
    class: "sv-speed", title: "speed", "aria-label": "speed",
    onchange: () => {
      const chosen = speed.value === "max" ? null : Number(speed.value);
      if (chosen !== null) session.speed = chosen;
      session.link?.setSpeed(chosen);
      speed.blur();
    },
  }, ...SPEEDS.map((s) => el("option", { value: String(s), text: `${s} ×`, selected: s === 1 })));
  if (session.link) speed.append(el("option", { value: "max", text: "fastest" }));

  const restart = button("back to the start (home)", "M3 3h2.4v10H3zM13 3v10L6 8z", () => {
    session.playing = false;
    if (session.link && !session.link.isRunning && session.t <= 1e-12) session.link.send({ do: "restart" });
    session.seek(0);
    session.tell("playing");
  });
  const back = button("one frame back (←)", "M11 3v10L4 8zM12 3h2v10h-2z", () => session.stepFrames(-1));
  const step = button("one step on (→)", "M5 3v10l7-5zM2 3h2v10H2z", () => forward(session));

  const draw = () => {
    const isPlaying = session.playing || session.link?.isRunning === true;
    icon(play, isPlaying ? PAUSE : PLAY);
    play.setAttribute("aria-label", isPlaying ? "pause (space)" : "play (space)");
    play.setAttribute("data-state", isPlaying ? "playing" : "stopped");
    slider.value = String(session.end > 0 ? (1000 * session.t) / session.end : 0);
    recorded.style.setProperty("--share", String(session.end > 0 ? session.run.end / session.end : 0));
    clock.textContent = `${session.t.toFixed(session.end < 10 ? 3 : 2)} s`;
    clock.title = `of ${format(session.end, 6)} s`;
    const real = session.link?.factor;
    factor.textContent = session.link ? (real ? `${format(real, 3)} × real time` : session.link.isDone ? "at its end" : "stands still") : "";
  };
  for (const topic of ["time", "frames", "playing", "runs", "live"] as const) session.on(topic, draw);
  draw();
  const line = el("div", { class: "sv-line" }, recorded, slider);
  return el("div", { class: "sv-transport", role: "group", "aria-label": "transport" }, restart, back, play, step, line, clock, speed, factor);
}

/** One frame on; at the end of a live run one base step more is simulated. */
export function forward(session: Session): void {
  const { link } = session;
  if (link && !link.isRunning && !link.isDone && session.t >= session.run.end - 1e-9) link.send({ do: "step" });
  else session.stepFrames(1);
}
