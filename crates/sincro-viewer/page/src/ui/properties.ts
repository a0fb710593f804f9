// The side panel: what the selected object is, where it is now, and its numbers; while a live run stands still they can be changed.

import { Quaternion, Vector3 } from "three";
import { el, format, plain } from "../format";
import type { ObjectView, Property } from "../film";
import type { Session } from "../session";
import type { Link } from "../link";

export function properties(session: Session): HTMLElement {
  const title = el("h3", { text: "Properties" });
  const now = el("table", { class: "sv-now" });
  const numbers = el("div", { class: "sv-numbers" });
  const body = el("div", {}, now, numbers);
  const draw = () => {
    const object = session.selected === null ? null : (session.view.objects[session.selected] ?? null);
    title.textContent = object ? object.path : session.film.scene;
    numbers.replaceChildren(...groups(session, object));
    drawNow();
  };
  const drawNow = () => {
    const object = session.selected === null ? null : (session.view.objects[session.selected] ?? null);
    const rows = object ? state(session, object) : [];
    for (const cell of numbers.querySelectorAll<HTMLElement>("[data-value]")) cell.textContent = format(session.run.value(session.t, cell.dataset["value"] as string));
    now.replaceChildren(...rows.map(([name, value, unit]) => el("tr", {}, el("th", { scope: "row", text: name }), el("td", { text: value }), el("td", { class: "sv-unit", text: unit }))));
  };
  session.on("selection", draw);
  session.on("properties", draw);
  session.on("runs", draw);
  session.on("live", draw);
  session.on("playing", draw);
  session.on("time", drawNow);
  draw();
  return el("section", { class: "sv-panel sv-properties" }, title, body);
}

type Row = [name: string, value: string, unit: string];

/** What can be read of an object now. */
function state(session: Session, object: ObjectView): Row[] {
  const { run, t } = session;
  if (run.times.n === 0) return [["kind", object.kind, ""]];
  const rows: Row[] = [["kind", object.kind, ""]];
  if (object.kind !== "coupling") rows.push(["position", vector(position(session, object).toArray()), "m"]);
  if (object.joint) {
    const { q_idx, n_q, v_idx, n_v } = object.joint;
    if (n_q === 1) {
      const slides = object.kind.startsWith("prismatic");
      const q = run.q(t, q_idx);
      rows.push(["coordinate", format(q), slides ? "m" : "rad"]);
      if (!slides) rows.push(["", format((q * 180) / Math.PI), "°"]);
      rows.push(["rate", format(run.v(t, v_idx)), slides ? "m/s" : "rad/s"]);
    } else {
      const list = (n: number, read: (k: number) => number) => Array.from({ length: n }, (_, k) => format(read(k), 3)).join("  ");
      rows.push(["coordinates", list(n_q, (k) => run.q(t, q_idx + k)), ""], ["rates", list(n_v, (k) => run.v(t, v_idx + k)), ""]);
    }
  }
  if (object.rotor) {
    const read = (what: 0 | 1 | 2) => format(run.rotor(t, object.rotor?.index ?? 0, what));
    rows.push(["speed", read(0), "rad/s"], ["thrust", read(1), "N"], ["torque", read(2), "N·m"]);
  }
  if (object.drag !== null) rows.push(["drag", vector(run.drag(t, object.drag)), "N"]);
  if (object.force !== null) rows.push(["force", vector(run.force(t, object.force)), "N"]);
  if (object.camera) rows.push(["field of view", format(object.camera.field_of_view_deg), "°"]);
  if (object.other_end) {
    const [mover, pose] = object.other_end;
    const opening = position(session, object).distanceTo(position(session, { ...object, mover, pose }));
    rows.push([object.kind.startsWith("distance") ? "distance" : "opening", format(opening < 1e-6 ? 0 : opening), "m"]);
  }
  return [...rows, ...contact(session, object)];
}

/** What touches a body: how many points press, and with what force in all. */
function contact(session: Session, object: ObjectView): Row[] {
  const { run, t, view } = session;
  const own = session.view.objects.indexOf(object);
  if (!view.surfaces.includes(own)) return [];
  const { from, to } = run.contactsAt(t);
  const force = new Vector3();
  let points = 0;
  for (let row = from; row < to; row++) {
    const [a, b] = [0, 1].map((c) => view.surfaces[run.contacts.at(row, c)] === own);
    if (a === b) continue;
    points++;
    force.addScaledVector(new Vector3(run.contacts.at(row, 5), run.contacts.at(row, 6), run.contacts.at(row, 7)), a ? 1 : -1);
  }
  return [["touches at", String(points), points === 1 ? "point" : "points"], ["contact force", vector(force.toArray()), "N"]];
}

/** Three components for the eye; what is nothing beside the others is zero. */
function vector(list: readonly number[]): string {
  const size = Math.hypot(...list);
  return list.map((x) => format(Math.abs(x) < 1e-6 * size ? 0 : x)).join("  ");
}

function position(session: Session, object: ObjectView): Vector3 {
  const local = new Vector3(object.pose[0], object.pose[1], object.pose[2]);
  if (object.mover === null) return local;
  const read = (c: number) => session.run.number(session.t, 7 * (object.mover as number) + c);
  return local.applyQuaternion(new Quaternion(read(3), read(4), read(5), read(6)).normalize()).add(new Vector3(read(0), read(1), read(2)));
}

function groups(session: Session, object: ObjectView | null): HTMLElement[] {
  const all = session.properties;
  const owners = object ? [object.path] : [...new Set(all.map((p) => p.owner))].filter((owner) => !owner.startsWith("/") || owner === "/");
  const made: HTMLElement[] = [];
  const heads: Record<string, string> = { "/": "world", experiment: "experiment" };
  for (const owner of owners) {
    const of = all.filter((p) => p.owner === owner);
    if (of.length === 0) continue;
    const head = object ? "numbers of the file" : (heads[owner] ?? owner.replace("diagram/", "block "));
    made.push(el("details", { open: object !== null || owner === "/" || owner === "experiment" }, el("summary", { text: head }), table(session, of)));
  }
  if (object) made.push(...recorded(session, object));
  if (object && made.length === 0) made.push(el("p", { class: "sv-quiet", text: "It has no numbers of its own." }));
  return object && session.link ? [...sliders(session, session.link, object), ...made] : made;
}

/** Signals of the object that are recorded: a click plots them. */
function recorded(session: Session, object: ObjectView): HTMLElement[] {
  const own = session.run.columns.filter((column) => column.name.startsWith(`${object.path}.`));
  if (own.length === 0) return [];
  const rows = own.map((column) => el("tr", {},
    el("th", { scope: "row" }, el("button", { class: "sv-link", title: `plot ${column.name}`, text: column.name.slice(object.path.length + 1), onclick: () => session.plot(column.name) })),
    el("td", { "data-value": column.name }), el("td", { class: "sv-unit", text: column.unit })));
  return [el("details", { open: true }, el("summary", { text: "recorded" }), el("table", {}, ...rows))];
}

function table(session: Session, list: Property[]): HTMLElement {
  const link = session.link;
  const canEdit = link !== null && !link.isRunning && link.isConnected;
  const rows = list.map((property) => {
    const edited = link?.edits.find(([path]) => path === property.path)?.[1];
    const cell = canEdit
      ? el("input", {
          type: "text", inputmode: "decimal", value: edited ?? String(property.value), "aria-label": property.path, spellcheck: "false", class: edited === undefined ? "" : "sv-edited",
          onchange: (event) => change(session, link, property, event.target as HTMLInputElement),
        })
      : el("span", { text: edited ?? plain(property.value) });
    return el("tr", { title: property.about, class: edited !== undefined && edited !== String(property.value) ? "sv-changed" : "" },
      el("th", { scope: "row", text: property.key }), el("td", {}, cell), el("td", { class: "sv-unit", text: property.unit }));
  });
  return el("table", {}, ...rows);
}

function change(session: Session, link: Link, property: Property, input: HTMLInputElement): void {
  const text = input.value.trim().replace("−", "-").replace(",", ".");
  if (text === "" || !Number.isFinite(Number(text))) {
    session.say(`\`${property.path}\` takes a number${property.unit ? ` in ${property.unit}` : ""}; “${input.value}” is none`);
    input.value = String(property.value);
    return;
  }
  link.edit(property.path, text);
}

/** A slider a scalar joint: while the run stands still, the mechanism is put there and a new run starts from it. */
function sliders(session: Session, link: Link, object: ObjectView): HTMLElement[] {
  if (!object.joint || object.joint.n_q !== 1 || link.isRunning || !link.isConnected) return [];
  const { q_idx } = object.joint;
  const slides = object.kind.startsWith("prismatic");
  const q = session.run.q(session.t, q_idx);
  const span = slides ? Math.max(1, 2 * Math.abs(q)) : Math.PI;
  const input = el("input", {
    type: "range", min: String(Math.min(-span, q)), max: String(Math.max(span, q)), step: String(span / 500), value: String(q), "aria-label": `place ${object.path}`,
    onchange: (event) => link.branch(session.t, [[q_idx, Number((event.target as HTMLInputElement).value)]]),
  });
  return [el("label", { class: "sv-slider" }, el("span", { text: `place it (${slides ? "m" : "rad"})` }), input)];
}
