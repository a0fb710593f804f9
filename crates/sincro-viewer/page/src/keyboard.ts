// Keys: space plays, arrows step, 1 to 9 are cameras.

import { firstBody } from "./ui/shown";
import { forward } from "./ui/transport";
import { cameraNames, type Stage } from "./three/stage";
import type { Session } from "./session";

export const KEYS = "space play · ← → one frame · shift ten · home end · 1–9 cameras · F follow · Z / Y undo, redo · Ctrl-drag pulls a body while a live run plays";

export function keyboard(root: HTMLElement, session: Session, stage: Stage): void {
  document.addEventListener("keydown", (event) => {
    const target = event.target as HTMLElement;
    // within a report keys are the report's, unless the reader works in the viewer
    if (!root.classList.contains("sv-full") && !root.contains(target)) return;
    const types = target instanceof HTMLInputElement && target.type !== "checkbox" && target.type !== "range";
    if (types || target instanceof HTMLSelectElement || event.ctrlKey || event.metaKey || event.altKey) return;
    if (target instanceof HTMLButtonElement && event.key === " ") target.blur();
    const camera = cameraNames(session)[Number(event.key) - 1];
    const n = event.shiftKey ? 10 : 1;
    const actions: Record<string, () => void> = {
      " ": () => session.togglePlay(),
      ArrowLeft: () => session.stepFrames(-n),
      ArrowRight: () => (n === 1 ? forward(session) : session.stepFrames(n)),
      Home: () => session.seek(0),
      End: () => session.seek(session.run.end),
      f: () => {
        session.follow = !session.follow;
        if (session.follow && session.selected === null) session.select(firstBody(session));
        session.tell("shown");
      },
      z: () => session.link?.undo(),
      y: () => session.link?.redo(),
      Escape: () => session.select(null),
    };
    const action = camera ? () => stage.frame(camera) : actions[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  });
}
