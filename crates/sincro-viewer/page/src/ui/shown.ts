// What is drawn over the bodies, and the cameras.

import { el } from "../format";
import { SHOWN, applies, type Session, type Shown } from "../session";
import { cameraNames, type Stage } from "../three/stage";

export function shown(session: Session, stage: Stage): HTMLElement {
  const toggles = (Object.keys(SHOWN) as Shown[]).map((key) =>
    el("label", { class: "sv-toggle", "data-toggle": key },
      el("input", {
        type: "checkbox", checked: session.shown[key], "data-shown": key,
        onchange: (event) => {
          session.shown[key] = (event.target as HTMLInputElement).checked;
          session.tell("shown");
        },
      }), SHOWN[key].label),
  );
  // a script may make the first sensor while the run goes on
  const offer = () => {
    for (const toggle of toggles) if (toggle.hidden) toggle.hidden = !applies(session.view, session.runs, toggle.dataset["toggle"] as Shown);
  };
  toggles.forEach((toggle) => (toggle.hidden = true));
  offer();
  session.on("runs", offer);
  session.on("frames", offer);
  const cameras = el("select", {
    "aria-label": "camera", title: "camera (keys 1 to 9)",
    onchange: (event) => {
      stage.frame((event.target as HTMLSelectElement).value);
      cameras.blur();
    },
  }, ...cameraNames(session).map((name) => el("option", { value: name, text: name })));
  const choose = () => (cameras.value = stage.cameraName);
  session.on("camera", choose);
  choose();
  const follow = el("label", { class: "sv-toggle" }, el("input", {
    type: "checkbox", "data-shown": "follow",
    onchange: (event) => {
      session.follow = (event.target as HTMLInputElement).checked;
      if (session.follow && session.selected === null) session.select(firstBody(session));
      stage.frame(cameras.value);
    },
  }), "follow the selected");
  session.on("shown", () => {
    for (const input of menu.querySelectorAll<HTMLInputElement>("input[data-shown]")) {
      const key = input.dataset["shown"] as Shown | "follow";
      input.checked = key === "follow" ? session.follow : session.shown[key];
    }
  });
  const picture = el("button", { class: "sv-small", text: "save the picture (PNG)", onclick: () => stage.savePicture() });
  const menu = el("details", { class: "sv-menu", "data-menu": "view" }, el("summary", { text: "View" }), el("div", { class: "sv-sheet" }, cameras, follow, ...toggles, picture));
  return menu;
}

export function firstBody(session: Session): number | null {
  const k = session.view.objects.findIndex((o) => o.kind === "body" && o.mover !== null);
  return k < 0 ? null : k;
}
