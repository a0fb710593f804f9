// The diagram's drawing with what the wires carry now: the wheel magnifies, a drag shifts, a click on a wire plots it.

import { el, format } from "../format";
import type { Session } from "../session";
import type { Scopes } from "./scopes";

/** Components of a vector that a wire's label shows; the rest are counted, and told on hovering. */
const MAX_COMPONENTS = 4;
/** Pixels a unit of the drawing, at most, when it is fitted. */
const LARGEST_FIT = 1.25;

export function diagram(session: Session, scopes: Scopes): HTMLElement | null {
  const { diagram: drawing } = session.film;
  if (!drawing) return null;
  // an HTML parser does not run what it parses into another document
  const parsed = new DOMParser().parseFromString(drawing, "text/html").querySelector("svg");
  if (!parsed) return null;
  const svg = document.importNode(parsed, true);
  svg.querySelectorAll("script, foreignObject").forEach((node) => node.remove());
  const wires = [...svg.querySelectorAll<SVGGElement>("g[data-signal]")].map((group) => ({ group, label: label(group) }));
  // everything that a wire carries, on hovering
  const told = new Map(wires.map(({ group }) => {
    const title = group.querySelector("title") ?? document.createElementNS("http://www.w3.org/2000/svg", "title");
    const before = title.textContent ?? "";
    title.replaceChildren(before);
    group.prepend(title);
    return [group, title] as const;
  }));
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
      const values = names.map((name) => format(session.run.value(session.t, name), 3));
      const shown = values.length > MAX_COMPONENTS ? [...values.slice(0, MAX_COMPONENTS), `… ${values.length}`] : values;
      label.textContent = values.length < 2 ? (values[0] ?? "") : `[${shown.join("  ")}]`;
      told.get(group)?.replaceChildren(names.map((name, k) => `${name} = ${values[k] as string}`).join("\n"));
    }
  };
  session.on("time", draw);
  session.on("runs", draw);
  const drawn = el("div", { class: "sv-drawing" }, svg as unknown as HTMLElement);
  const fit = magnified(svg, drawn);
  const tools = el("div", { class: "sv-diagram-tools" },
    el("button", { class: "sv-small", text: "fit", title: "the whole diagram (double click)", onclick: fit }),
    el("p", { class: "sv-quiet sv-hint", text: "The wheel magnifies, a drag shifts. Numbers on wires are what they carry at the time that is shown; click a wire to plot it." }));
  const node = el("div", { class: "sv-diagram" }, drawn, tools);
  new ResizeObserver(draw).observe(node);
  return node;
}

/** Lets the wheel magnify a drawing and a drag shift it; returns what shows all of it again. */
function magnified(svg: SVGSVGElement, holder: HTMLElement): () => void {
  const number = (name: string) => Number.parseFloat(svg.getAttribute(name) ?? "0");
  const own = (svg.getAttribute("viewBox") ?? `0 0 ${number("width")} ${number("height")}`).split(/[\s,]+/).map(Number) as [number, number, number, number];
  let box = [...own] as [number, number, number, number];
  svg.removeAttribute("width");
  svg.removeAttribute("height");
  svg.removeAttribute("style");
  svg.setAttribute("preserveAspectRatio", "xMidYMid meet");
  const show = () => svg.setAttribute("viewBox", box.join(" "));
  const fit = () => {
    // a small diagram is not blown up
    const { clientWidth: w, clientHeight: h } = holder;
    const factor = w > 0 && h > 0 ? Math.max(1, Math.min(w / own[2], h / own[3]) / LARGEST_FIT) : 1;
    box = [own[0] - ((factor - 1) * own[2]) / 2, own[1] - ((factor - 1) * own[3]) / 2, factor * own[2], factor * own[3]];
    show();
  };
  const scale = () => Math.max(box[2] / Math.max(1, holder.clientWidth), box[3] / Math.max(1, holder.clientHeight));
  /** A place of the screen in the drawing. */
  const at = (event: MouseEvent): [number, number] => {
    const frame = holder.getBoundingClientRect();
    const s = scale();
    return [box[0] + box[2] / 2 + (event.clientX - frame.left - frame.width / 2) * s, box[1] + box[3] / 2 + (event.clientY - frame.top - frame.height / 2) * s];
  };
  holder.addEventListener("wheel", (event) => {
    event.preventDefault();
    const [x, y] = at(event);
    const factor = Math.exp(Math.max(-0.5, Math.min(0.5, event.deltaY * 0.0015)));
    const next = box[2] * factor;
    if (next < own[2] / 40 || next > own[2] * 8) return;
    box = [x - (x - box[0]) * factor, y - (y - box[1]) * factor, next, box[3] * factor];
    show();
  }, { passive: false });
  let from: { x: number; y: number; box: typeof box } | null = null;
  let wasDragged = false;
  holder.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    from = { x: event.clientX, y: event.clientY, box: [...box] as typeof box };
    wasDragged = false;
  });
  holder.addEventListener("pointermove", (event) => {
    if (!from) return;
    const [dx, dy] = [event.clientX - from.x, event.clientY - from.y];
    if (!wasDragged && Math.hypot(dx, dy) < 4) return;
    if (!wasDragged) holder.setPointerCapture(event.pointerId);
    wasDragged = true;
    holder.classList.add("sv-dragged");
    const s = scale();
    box = [from.box[0] - dx * s, from.box[1] - dy * s, from.box[2], from.box[3]];
    show();
  });
  const end = () => {
    from = null;
    holder.classList.remove("sv-dragged");
  };
  holder.addEventListener("pointerup", end);
  holder.addEventListener("pointercancel", end);
  // a drag that ends on a wire is no click on it
  holder.addEventListener("click", (event) => {
    if (wasDragged) event.stopPropagation();
    wasDragged = false;
  }, { capture: true });
  holder.addEventListener("dblclick", fit);
  let wasShown = false;
  new ResizeObserver(() => {
    if (holder.clientWidth > 0 && !wasShown) fit();
    wasShown = holder.clientWidth > 0;
  }).observe(holder);
  show();
  return fit;
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
