// One plot: recorded signals of one unit over time, references and other runs over them, the time that is shown as a line.

import uPlot from "uplot";
import { el, exact, format, plain, save } from "../format";
import { countUpTo } from "../growing";
import type { Run } from "../run";
import type { Session } from "../session";

/** Okabe and Ito's colours, darker on light paper and lighter on dark. */
const LIGHT = ["#0072b2", "#d55e00", "#00805c", "#b0568f", "#8a6d00", "#3b8fc4"];
const DARK = ["#56b4e9", "#ff9d57", "#3fd0a4", "#e69bc6", "#e6c229", "#9ad0f5"];
const DASHES = [[9, 4], [2, 3], [9, 3, 2, 3], [15, 5]];

interface Line {
  run: Run;
  signal: string;
  kind: "run" | "reference";
  order: number;
}

export class Scope {
  readonly node = el("div", { class: "sv-scope" });
  private readonly holder = el("div", { class: "sv-plot" });
  private readonly marker = el("div", { class: "sv-marker" });
  private plot: uPlot | null = null;
  private lines: Line[] = [];
  private drawn = "";

  constructor(private readonly session: Session, readonly signals: string[], private readonly title: string, readonly remove: () => void) {
    const button = (text: string, label: string, action: () => void) => el("button", { class: "sv-small", title: label, "aria-label": label, onclick: action, text });
    this.node.append(
      el("header", {}, el("span", { class: "sv-title", text: this.name }),
        el("span", { class: "sv-tools" }, button("CSV", "save the numbers as CSV", () => this.saveCsv()), button("SVG", "save the picture as SVG", () => this.saveSvg()),
          button("PNG", "save the picture as PNG", () => this.savePng()), button("✕", "close the plot", () => this.remove()))),
      this.holder,
    );
  }

  get name(): string {
    return this.title || this.signals.join(", ");
  }

  get unit(): string {
    return this.session.run.columns.find((c) => c.name === this.signals[0])?.unit ?? "";
  }

  /** Everything anew: other signals, other runs, another size. */
  rebuild(): void {
    const width = Math.floor(this.holder.clientWidth);
    if (width < 40 || !this.node.isConnected) return;
    const isDark = matchMedia("(prefers-color-scheme: dark)").matches;
    const key = JSON.stringify([width, this.height(), isDark, this.signals, this.session.active, this.session.runs.map((r) => [r.id, r.isVisible, r.times.n > 0])]);
    if (key === this.drawn && this.plot) {
      this.refresh();
      return;
    }
    this.drawn = key;
    this.plot?.destroy();
    this.lines = this.wanted();
    const colors = isDark ? DARK : LIGHT;
    const [ink, grid] = isDark ? ["#b9c1ca", "#2b323a"] : ["#4a525c", "#e4e7eb"];
    const axis = { stroke: ink, grid: { stroke: grid, width: 1 }, ticks: { stroke: grid, width: 1 }, font: "12px system-ui, sans-serif" };
    const unit = this.unit;
    this.plot = new uPlot(
      {
        width, height: this.height(), class: "sv-uplot",
        cursor: { drag: { x: true, y: false, setScale: true }, points: { size: 6 } },
        scales: { x: { time: false, range: (_, low, high) => (low === null || low === high ? [0, this.session.film.duration || 1] : [low, high]) }, y: { range: (_, low, high) => range(low, high) } },
        axes: [
          { ...axis, values: (_, at) => at.map((t) => (t === null ? "" : `${plain(t)} s`)), space: 70, size: 28 },
          { ...axis, values: (_, at) => at.map((y) => (y === null ? "" : plain(y))), size: 62, label: unit ? `[${unit}]` : "", labelSize: 18, labelFont: axis.font },
        ],
        series: [
          { label: "t", value: (plot, t) => (t === null || t === undefined ? "–" : `${number(plot, t)} s`) },
          ...this.lines.map((line) => this.series(line, colors, ink)),
        ],
        hooks: { setScale: [() => this.mark()], ready: [() => this.mark()], setCursor: [() => this.tell()] },
      },
      this.data(), this.holder,
    );
    this.plot.over.append(this.marker);
    this.listen(this.plot);
    this.mark();
  }

  /** As high as the panel has room for, with the legend below. */
  private height(): number {
    const panel = this.node.closest(".sv-plot-area")?.clientHeight ?? 0;
    return Math.min(260, Math.max(150, panel - 92));
  }

  /** New numbers in the same lines. */
  refresh(): void {
    if (!this.plot) return this.rebuild();
    this.plot.setData(this.data(), this.plot.scales["x"]?.min === undefined || !this.isZoomed());
    this.mark();
  }

  /** The line at the time that is shown. */
  mark(): void {
    if (!this.plot) return;
    const at = this.plot.valToPos(this.session.t, "x");
    this.marker.hidden = !(at >= 0 && at <= this.plot.over.clientWidth);
    this.marker.style.transform = `translateX(${at}px)`;
    this.tell();
  }

  /** The legend has the values at the time that is shown, while no mouse is over the plot. */
  private tell(): void {
    const { plot, session } = this;
    if (!plot || (plot.cursor.left ?? -1) >= 0) return;
    const times = plot.data[0];
    if (times.length === 0) return;
    const now = Math.max(0, countUpTo(times as ArrayLike<number>, times.length, session.t + 1e-12) - 1);
    // of each line the last value that it has by then
    const last = (column: ArrayLike<number | null | undefined>) => {
      let k = now;
      while (k > 0 && (column[k] === null || column[k] === undefined)) k--;
      return k;
    };
    plot.setLegend({ idxs: plot.data.map((column, c) => (c === 0 ? now : last(column))) }, false);
  }

  private isZoomed(): boolean {
    const { min, max } = this.plot?.scales["x"] ?? {};
    const times = this.plot?.data[0] ?? [];
    return min !== undefined && max !== undefined && times.length > 1 && (min > (times[0] as number) + 1e-12 || max < (times[times.length - 1] as number) - 1e-12);
  }

  private wanted(): Line[] {
    const runs = [this.session.run, ...this.session.runs.filter((run) => run.isVisible && run !== this.session.run)];
    const lines: Line[] = [];
    for (const signal of this.signals) {
      runs.forEach((run, order) => {
        if (run.columns.some((c) => c.name === signal)) lines.push({ run, signal, kind: "run", order });
      });
      if (this.session.run.references.has(signal)) lines.push({ run: this.session.run, signal, kind: "reference", order: 0 });
    }
    return lines;
  }

  private series(line: Line, colors: string[], ink: string): uPlot.Series {
    const color = colors[this.signals.indexOf(line.signal) % colors.length] as string;
    const name = short(line.signal, this.signals);
    const label = line.kind === "reference" ? `${name} expected` : line.order > 0 ? `${name} · ${line.run.name}` : name;
    const value = (plot: uPlot, y: number | null) => (y === null || y === undefined ? "–" : `${number(plot, y)} ${this.unit}`.trim());
    if (line.kind === "reference") return { label, value, stroke: ink, width: 1.2, dash: [4, 5], spanGaps: true, points: { show: false } };
    const other = line.order > 0 ? { dash: DASHES[(line.order - 1) % DASHES.length] as number[], width: 1.4 } : { width: 2 };
    return { label, value, stroke: color, spanGaps: true, points: { show: false }, ...other };
  }

  private data(): uPlot.AlignedData {
    const tables = this.lines.map((line): uPlot.AlignedData => {
      if (line.kind === "reference") {
        const reference = line.run.references.get(line.signal) as { times: Float64Array; values: Float64Array };
        return [reference.times, reference.values] as unknown as uPlot.AlignedData;
      }
      const c = line.run.columns.findIndex((column) => column.name === line.signal);
      return [line.run.rowTimes.view(), line.run.rows.column(c)] as unknown as uPlot.AlignedData;
    });
    return tables.length === 0 ? [[]] : uPlot.join(tables);
  }

  /** A click without a drag goes there. */
  private listen(plot: uPlot): void {
    let from = 0;
    plot.over.addEventListener("mousedown", (event) => (from = event.clientX));
    plot.over.addEventListener("mouseup", (event) => {
      if (Math.abs(event.clientX - from) > 3) return;
      this.session.playing = false;
      this.session.seek(plot.posToVal(event.clientX - plot.over.getBoundingClientRect().left, "x"));
      this.session.tell("playing");
    });
  }

  private file(): string {
    return `${this.session.film.scene}-${this.name.replace(/[^A-Za-z0-9]+/g, "-").replace(/^-|-$/g, "")}`.slice(0, 80);
  }

  private labels(): string[] {
    const name = (line: Line) => (line.kind === "reference" ? `${line.signal} expected` : line.order > 0 ? `${line.signal} · ${line.run.name}` : line.signal);
    return ["t [s]", ...this.lines.map((line) => `${name(line)} [${this.unit}]`)];
  }

  private saveCsv(): void {
    if (!this.plot) return;
    const quoted = (text: string) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
    const rows = [this.labels().map(quoted).join(",")];
    const [times, ...columns] = this.plot.data;
    times.forEach((t, k) => rows.push([t, ...columns.map((c) => c[k] ?? "")].join(",")));
    save(`${this.file()}.csv`, new Blob([rows.join("\n") + "\n"], { type: "text/csv" }));
  }

  private savePng(): void {
    this.plot?.ctx.canvas.toBlob((blob) => blob && save(`${this.file()}.png`, blob));
  }

  private saveSvg(): void {
    if (!this.plot) return;
    save(`${this.file()}.svg`, new Blob([svg(this.plot, this.name, this.unit)], { type: "image/svg+xml" }));
  }
}

/** A little more than what there is; of what never changes, something on both sides. */
function range(low: number | null, high: number | null): [number, number] {
  if (low === null || high === null) return [-1, 1];
  const room = high > low ? 0.06 * (high - low) : Math.max(0.1 * Math.abs(low), low === 0 ? 1 : 0);
  return [low - room, high + room];
}

/** What stands behind the last `/` of a signal's path, if that names it among others. */
function short(signal: string, among: string[]): string {
  const last = (name: string) => name.slice(name.lastIndexOf("/") + 1);
  return among.filter((name) => last(name) === last(signal)).length > 1 ? signal : last(signal);
}

/** All digits of the sample under the mouse, a few of that at the time that is shown. */
function number(plot: uPlot, x: number): string {
  return (plot.cursor.left ?? -1) >= 0 ? exact(x) : format(x, 5);
}

const escape = (text: string) => text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);

/** The plot as it is zoomed now, in the light colours. */
function svg(plot: uPlot, title: string, unit: string): string {
  const [w, h, left, top] = [plot.over.clientWidth, plot.over.clientHeight, 70, 30];
  const parts: string[] = [];
  const [times, ...columns] = plot.data;
  const ticks = (scale: "x" | "y") => {
    const { min = 0, max = 1 } = plot.scales[scale] ?? {};
    return Array.from({ length: 6 }, (_, k) => (min as number) + ((max as number) - (min as number)) * (k / 5));
  };
  for (const t of ticks("x")) {
    const x = left + plot.valToPos(t, "x");
    parts.push(`<path d="M${x.toFixed(1)} ${top}v${h}" stroke="#e4e7eb"/><text x="${x.toFixed(1)}" y="${top + h + 18}" text-anchor="middle">${format(t)} s</text>`);
  }
  for (const y of ticks("y")) {
    const at = top + plot.valToPos(y, "y");
    parts.push(`<path d="M${left} ${at.toFixed(1)}h${w}" stroke="#e4e7eb"/><text x="${left - 6}" y="${(at + 4).toFixed(1)}" text-anchor="end">${format(y)}</text>`);
  }
  columns.forEach((column, c) => {
    const series = plot.series[c + 1] as uPlot.Series;
    const points = Array.from(times as ArrayLike<number>, (t, k) => (column[k] == null ? "" : `${(left + plot.valToPos(t, "x")).toFixed(1)},${(top + plot.valToPos(column[k] as number, "y")).toFixed(1)}`));
    const color = LIGHT[c % LIGHT.length] as string;
    parts.push(`<polyline points="${points.filter(Boolean).join(" ")}" fill="none" stroke="${color}" stroke-width="1.8" clip-path="url(#c)" ${series.dash ? `stroke-dasharray="${series.dash.join(" ")}"` : ""}/>`);
    parts.push(`<text x="${left + 8}" y="${top + h + 38 + 16 * c}" fill="${color}">— ${escape(String(series.label))}</text>`);
  });
  const height = top + h + 48 + 16 * columns.length;
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${left + w + 20}" height="${height}" font-family="Helvetica, Arial, sans-serif" font-size="12"><rect width="100%" height="100%" fill="#fff"/><clipPath id="c"><rect x="${left}" y="${top}" width="${w}" height="${h}"/></clipPath><text x="${left}" y="18" font-weight="600">${escape(title)}${unit ? ` [${escape(unit)}]` : ""}</text>${parts.join("")}</svg>\n`;
}
