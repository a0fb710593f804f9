// Starts the page: with a film that stands in it, or with one that the server sends.

import "uplot/dist/uPlot.min.css";
import "../../../sincro-figures/src/draw/draw.css";
import "./style.css";
import { el } from "./format";
import { readFilm } from "./film";
import { layout } from "./layout";
import { Link } from "./link";
import { Session } from "./session";

async function start(root: HTMLElement): Promise<void> {
  const embedded = document.getElementById("sincro-film");
  if (embedded?.textContent) {
    layout(root, new Session(readFilm(embedded.textContent)));
    return;
  }
  const token = location.search;
  if (root.dataset["source"] === "film") {
    const answer = await fetch(`film.json${token}`);
    if (!answer.ok) throw new Error(`sincro answers “${answer.status} ${answer.statusText}”`);
    layout(root, new Session(readFilm(await answer.text())));
    return;
  }
  const { film, link } = await Link.open(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/live${token}`);
  const session = new Session(film);
  session.link = link;
  // the first run comes right after the scene
  await new Promise<void>((resolve) => {
    session.on("runs", () => resolve());
    link.attach(session);
  });
  layout(root, session);
}

const root = document.getElementById("sincro-viewer");
if (root) {
  start(root).catch((error: unknown) => {
    root.replaceChildren(el("p", { class: "sv-failed", role: "alert", text: error instanceof Error ? error.message : String(error) }));
  });
}
