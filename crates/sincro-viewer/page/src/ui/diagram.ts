// The diagram's drawing with what the wires carry now; a click on a wire plots it.

import { el, format } from "../format";
import type { Session } from "../session";
import type { Scopes } from "./scopes";

export function diagram(session: Session, scopes: Scopes): HTMLElement | null {
  const { diagram: drawing } = session.film;
  if (!drawing) return null;
  // an HTML parser does not run what it parses into another document
  const parsed = new DOMParser().parseFromString(drawing, "text/html").querySelector("svg");
  if (!parsed) return null;
  const svg = document.importNode(parsed, true);
  svg.querySelectorAll("script, foreignObject").forEach((node) => node.remove());
  const wires = [...svg.querySelectorAll<SVGGElement>("g[data-signal]")].map((group) => ({ group, label: label(group) }));
  const columnsOf = (group: SVGGElement): string[] => {
    const names = [group.dataset["signal"] ?? "", group.dataset["block"] ?? ""];
    for (const name of names) {
      const found = session.run.columns.filter((c) => c.name === name || c.name.startsWith(`${name}[`)).map((c) => c.name);
      // a wire that carries some of the components only
      const [from, to] = (group.dataset["part"] ?? "0 9999").split(" ").map(Number) as [number, number];
      if (name && found.length > 0) return found.slice(from, to);
    }
    return [];
  };
  for (const { group } of wires) {
    group.addEventListener("click", () => {
      const names = columnsOf(group);
      if (names.length === 0) session.say(`\`${group.dataset["signal"] ?? ""}\` was not recorded; add it to \`record\` in experiment.toml`);
      names.forEach((name) => scopes.add(name));
    });
  }
  const draw = () => {
    if (!svg.parentElement?.offsetParent) return;
    for (const { group, label } of wires) {
      const names = columnsOf(group);
      group.classList.toggle("sv-recorded-wire", names.length > 0);
      const values = names.slice(0, 2).map((name) => format(session.run.value(session.t, name), 3));
      label.textContent = values.length === 0 ? "" : values.join("  ") + (names.length > 2 ? " …" : "");
    }
  };
  session.on("time", draw);
  session.on("runs", draw);
  const node = el("div", { class: "sv-diagram" }, el("div", { class: "sv-drawing" }, svg as unknown as HTMLElement), el("p", { class: "sv-quiet sv-hint", text: "Numbers on wires are what they carry at the time that is shown; click a wire to plot it." }));
  new ResizeObserver(draw).observe(node);
  return node;
}

/** A text above the first level piece of a wire, at most half way to its end. */
function label(group: SVGGElement): SVGTextElement {
  const text = document.createElementNS("http://www.w3.org/2000/svg", "text");
  const [x, y] = (group.dataset["at"] ?? "0 0").split(" ").map(Number) as [number, number];
  text.setAttribute("x", String(x + 4));
  text.setAttribute("y", String(y - 4));
  text.setAttribute("class", "sv-carried");
  // after the blocks, so that none lies over it
  group.parentNode?.append(text);
  return text;
}
