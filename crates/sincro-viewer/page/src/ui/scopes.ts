// The plots and the list of signals beside them: click a signal to plot it; what has another unit gets a plot of its own.

import { el, format } from "../format";
import type { Session } from "../session";
import { Scope } from "./scope";

export class Scopes {
  readonly node: HTMLElement;
  private readonly list = el("ul", { class: "sv-signals" });
  private readonly plots = el("div", { class: "sv-plots" });
  private readonly search = el("input", { type: "search", placeholder: "search signals", "aria-label": "search signals", oninput: () => this.drawList() });
  private scopes: Scope[] = [];
  private isStale = false;

  constructor(private readonly session: Session) {
    const hint = el("p", { class: "sv-quiet sv-hint", text: "Drag in a plot to zoom, double-click to see all, click to go there." });
    this.node = el("div", { class: "sv-scopes" }, el("section", { class: "sv-signal-list" }, this.search, this.list), el("div", { class: "sv-plot-area" }, this.plots, hint));
    session.plot = (signal) => this.add(signal);
    this.open();
    session.on("time", () => this.scopes.forEach((scope) => scope.mark()));
    session.on("frames", () => (this.isStale = true));
    session.on("time", () => this.drawValues());
    for (const topic of ["runs", "plots"] as const) {
      session.on(topic, () => {
        if (this.scopes.length === 0) this.open();
        this.drawList();
        this.rebuild();
      });
    }
    new ResizeObserver(() => this.rebuild()).observe(this.plots);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.rebuild());
    // a run that grows is drawn ten times a second at most
    setInterval(() => {
      if (!this.isStale || !this.node.offsetParent) return;
      this.isStale = false;
      this.scopes.forEach((scope) => scope.refresh());
    }, 100);
    this.drawList();
  }

  /** Plots a signal, or takes it out again. */
  toggle(signal: string): void {
    const column = this.session.run.columns.find((c) => c.name === signal);
    if (!column) return;
    const holding = this.scopes.find((scope) => scope.signals.includes(signal));
    if (holding) {
      const rest = holding.signals.filter((name) => name !== signal);
      const at = this.scopes.indexOf(holding);
      this.scopes.splice(at, 1, ...(rest.length > 0 ? [this.scope(rest)] : []));
    } else {
      const same = [...this.scopes].reverse().find((scope) => scope.unit === column.unit && scope.signals.length < 6);
      if (same) this.scopes.splice(this.scopes.indexOf(same), 1, this.scope([...same.signals, signal]));
      else this.scopes.push(this.scope([signal]));
    }
    this.show();
  }

  /** Plots a signal if it is not. */
  add(signal: string): void {
    if (!this.scopes.some((scope) => scope.signals.includes(signal))) this.toggle(signal);
  }

  rebuild(): void {
    this.scopes.forEach((scope) => scope.rebuild());
  }

  private scope(signals: string[], title = ""): Scope {
    const scope: Scope = new Scope(this.session, signals, title, () => {
      this.scopes = this.scopes.filter((known) => known !== scope);
      this.show();
    });
    return scope;
  }

  /** What the experiment plots; else what it records, a plot a unit. */
  private open(): void {
    const run = this.session.run;
    if (!run) return;
    const known = new Set(run.columns.map((c) => c.name));
    const asked = this.session.film.plots.map(([title, signals]) => ({ title, signals: signals.filter((s) => known.has(s)) })).filter(({ signals }) => signals.length > 0);
    const recorded = new Set(this.session.film.record ?? []);
    const named = run.columns.filter((c) => recorded.has(c.name));
    const offered = named.length > 0 ? named : run.columns.slice(0, 4);
    const units = [...new Set(offered.map((c) => c.unit))];
    const byUnit = units.map((unit) => ({ title: "", signals: offered.filter((c) => c.unit === unit).slice(0, 6).map((c) => c.name) }));
    const groups = asked.length > 0 ? asked.slice(0, 3) : byUnit.slice(0, 4);
    this.scopes = groups.map(({ title, signals }) => this.scope(signals, title));
    this.show();
  }

  private show(): void {
    this.plots.replaceChildren(...this.scopes.map((scope) => scope.node));
    if (this.scopes.length === 0) this.plots.append(el("p", { class: "sv-quiet", text: "Click a signal to plot it." }));
    this.rebuild();
    this.drawList();
  }

  private drawList(): void {
    const run = this.session.run;
    if (!run) return;
    const wanted = this.search.value.trim().toLowerCase();
    const shown = run.columns.filter((c) => c.name.toLowerCase().includes(wanted)).slice(0, 400);
    const recorded = new Set(this.session.film.record ?? []);
    const item = (column: (typeof shown)[number]) => {
      const isOn = this.scopes.some((scope) => scope.signals.includes(column.name));
      const bar = column.errorBar === null ? "" : `, known to ± ${format(column.errorBar, 2)} ${column.unit}`;
      return el("li", {}, el("button", {
        class: isOn ? "sv-signal sv-on" : "sv-signal", "aria-pressed": String(isOn), "data-signal": column.name, title: `${column.name}${bar}`, onclick: () => this.toggle(column.name),
      }, el("span", { class: "sv-name" }, el("bdi", { text: column.name })), el("span", { class: "sv-value" })));
    };
    const others = shown.filter((column) => !recorded.has(column.name));
    const own = shown.filter((column) => recorded.has(column.name));
    this.list.replaceChildren(...own.map(item));
    if (others.length > 0 && own.length > 0) this.list.append(el("li", { class: "sv-quiet sv-more", text: "not in `record`:" }));
    this.list.append(...others.map(item));
    this.drawValues();
  }

  private drawValues(): void {
    if (!this.list.offsetParent) return;
    for (const button of this.list.querySelectorAll<HTMLElement>("[data-signal]")) {
      const name = button.dataset["signal"] as string;
      const column = this.session.run.columns.find((c) => c.name === name);
      const value = this.session.run.value(this.session.t, name);
      (button.lastElementChild as HTMLElement).textContent = value === null ? "" : `${format(value)} ${column?.unit ?? ""}`;
    }
  }
}
