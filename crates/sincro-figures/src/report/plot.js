// Plots of a page: values under the pointer, a part magnified. Reads the curves from the figures' own paths; without this
// script the figures are the same pictures.
(() => {
  "use strict";
  // overlap of the curves over the frame [px], as in the program that draws them
  const SPILL = 5;
  // least part of an axis that is magnified
  const MIN_PART = 1e-4;

  const element = (name, attributes, text) => {
    const made = document.createElementNS(document.querySelector("svg").namespaceURI, name);
    for (const key in attributes) made.setAttribute(key, attributes[key]);
    if (text !== undefined) made.textContent = text;
    return made;
  };

  const scale = (text) => {
    const [low, high, log, origin, power] = text.split(" ").map(Number);
    return { low, high, log: log === 1, origin, power };
  };
  const place = (s, fraction) => s.low + fraction * (s.high - s.low);
  const valueAt = (s, fraction) => (s.log ? 10 ** place(s, fraction) : place(s, fraction));

  // digits that a reader can tell apart in the part shown
  const written = (s, part, value) => {
    const range = s.log ? Math.abs(value) : Math.abs((part[1] - part[0]) * (s.high - s.low));
    const digits = value === 0 || range === 0 ? 4 : Math.ceil(Math.log10(Math.abs(value) / range)) + 4;
    return String(Number(value.toPrecision(Math.min(15, Math.max(2, digits))))).replace("-", "−");
  };

  // labelled ticks of the part of an axis that is shown: place within that part, and label
  const ticks = (s, [from, to], most) => {
    const low = place(s, from), high = place(s, to), list = [];
    const add = (at, label) => list.push({ at: (at - low) / (high - low), label: label.replace("-", "−") });
    if (s.log && high - low >= 1) {
      const every = Math.max(1, Math.ceil((high - low) / most));
      for (let k = Math.ceil(low); k <= high; k += every) add(k, `1e${k}`);
      return list;
    }
    const [a, b] = s.log ? [10 ** low, 10 ** high] : [(low - s.origin) / 10 ** s.power, (high - s.origin) / 10 ** s.power];
    const raw = (b - a) / Math.max(2, most), decade = 10 ** Math.floor(Math.log10(raw));
    const step = [1, 2, 5, 10].map((m) => m * decade).find((candidate) => candidate >= raw * 0.999);
    const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
    for (let k = Math.ceil(a / step - 1e-6); k <= b / step + 1e-6; k++) {
      const label = (k * step).toFixed(Math.min(20, decimals));
      add(s.log ? Math.log10(k * step) : k * step * 10 ** s.power + s.origin, Number(label) === 0 ? label.replace("-", "") : label);
    }
    return list;
  };

  // pieces of a curve as lists of points; a path has one `M` a piece and relative steps
  const pieces = (path) => {
    const list = [];
    for (const piece of path.getAttribute("d").split("M").slice(1)) {
      const numbers = (piece.match(/-?[\d.]+/g) || []).map(Number);
      const points = [[numbers[0], numbers[1]]];
      for (let k = 2; k + 1 < numbers.length; k += 2) {
        const last = points[points.length - 1];
        points.push([last[0] + numbers[k], last[1] + numbers[k + 1]]);
      }
      list.push(points);
    }
    return list;
  };
  // ordinate of a curve at an abscissa; none where the curve has a gap
  const ordinate = (curve, x) => {
    for (const points of curve) {
      for (let k = 1; k < points.length; k++) {
        const [a, b] = [points[k - 1], points[k]];
        if ((a[0] <= x && x <= b[0]) || (b[0] <= x && x <= a[0])) {
          return b[0] === a[0] ? b[1] : a[1] + ((x - a[0]) / (b[0] - a[0])) * (b[1] - a[1]);
        }
      }
    }
    return undefined;
  };

  class Panel {
    constructor(clip) {
      this.clip = clip;
      this.group = clip.parentNode;
      const number = (name) => Number(clip.getAttribute(name));
      this.left = number("x") + SPILL;
      this.top = number("y") + SPILL;
      this.width = number("width") - 2 * SPILL;
      this.height = number("height") - 2 * SPILL;
      this.x = scale(clip.dataset.x);
      this.y = scale(clip.dataset.y);
      this.part = [0, 1];
      this.view = element("g", { class: "sp-view" });
      this.view.append(...clip.childNodes);
      clip.append(this.view);
      this.fresh = element("g", {});
      this.group.insertBefore(this.fresh, clip);
      this.paths = [...clip.querySelectorAll("path[data-name]")];
    }
    curves() {
      this.known ||= this.paths.map((path) => ({ path, points: pieces(path) }));
      return this.known;
    }
    has(x, y) {
      return x >= this.left && x <= this.left + this.width && y >= this.top && y <= this.top + this.height;
    }
    show(across, isWhole) {
      const [a, b] = across, [c, d] = this.part;
      const sx = 1 / (b - a), sy = 1 / (d - c);
      const tx = SPILL * (1 - sx) - this.width * a * sx, ty = SPILL * (1 - sy) - this.height * (1 - d) * sy;
      this.view.setAttribute("transform", isWhole ? "" : `translate(${tx} ${ty}) scale(${sx} ${sy})`);
      this.group.classList.toggle("sp-magnified", !isWhole);
      this.fresh.replaceChildren();
      if (isWhole) return;
      let grid = "";
      for (const tick of ticks(this.x, across, this.width / 80)) {
        grid += `M${this.left + tick.at * this.width} ${this.top}v${this.height}`;
      }
      for (const tick of ticks(this.y, this.part, this.height / 34)) {
        const y = this.top + (1 - tick.at) * this.height;
        grid += `M${this.left} ${y}h${this.width}`;
        const at = { x: this.left - 8, y: y + 4.3, "font-size": 12, "text-anchor": "end", class: "sp-quiet" };
        this.fresh.append(element("text", at, tick.label));
      }
      this.fresh.prepend(element("path", { class: "sp-grid", d: grid }));
    }
    // range of all values of the curves, as parts of the axis
    whole() {
      const all = this.curves().flatMap((curve) => curve.points.flat()).map((p) => 1 - (p[1] - SPILL) / this.height);
      const low = all.reduce((a, b) => Math.min(a, b), 0), high = all.reduce((a, b) => Math.max(a, b), 1);
      const air = low < 0 || high > 1 ? 0.03 * (high - low) : 0;
      return [low - (low < 0 ? air : 0), high + (high > 1 ? air : 0)];
    }
  }

  class Plot {
    constructor(svg, clips) {
      this.svg = svg;
      this.panels = clips.map((clip) => new Panel(clip));
      this.across = [0, 1];
      this.cross = element("path", { class: "sp-limit", "pointer-events": "none" });
      this.box = element("rect", { class: "sp-box", "pointer-events": "none", visibility: "hidden" });
      this.freshTicks = element("g", {});
      svg.append(this.freshTicks, this.cross, this.box);
      this.reading = document.createElement("div");
      this.reading.className = "reading";
      this.buttons = document.createElement("div");
      this.buttons.className = "plot-buttons";
      this.button("whole", "show the whole figure again (double click)", () => this.reset());
      if (svg.querySelector(".sp-spike")) this.button("spikes", "show the spikes whole", () => this.showSpikes());
      svg.parentNode.append(this.reading, this.buttons);
      svg.addEventListener("pointermove", (event) => this.move(event));
      svg.addEventListener("pointerleave", () => this.leave());
      svg.addEventListener("pointerdown", (event) => this.press(event));
      svg.addEventListener("pointerup", (event) => this.release(event));
      svg.addEventListener("dblclick", () => this.reset());
    }
    button(label, title, act) {
      const made = document.createElement("button");
      Object.assign(made, { type: "button", textContent: label, title, onclick: act });
      this.buttons.append(made);
    }
    at(event) {
      const frame = this.svg.getBoundingClientRect(), wide = this.svg.viewBox.baseVal.width;
      const factor = wide / frame.width;
      return [(event.clientX - frame.left) * factor, (event.clientY - frame.top) * factor];
    }
    panelAt([x, y]) {
      return this.panels.find((panel) => panel.has(x, y));
    }
    show() {
      const isAcross = this.across[0] !== 0 || this.across[1] !== 1;
      for (const panel of this.panels) panel.show(this.across, !isAcross && panel.part[0] === 0 && panel.part[1] === 1);
      this.svg.classList.toggle("sp-across", isAcross);
      this.freshTicks.replaceChildren();
      const last = this.panels[this.panels.length - 1];
      if (!isAcross) return;
      for (const tick of ticks(last.x, this.across, last.width / 80)) {
        const at = { x: last.left + tick.at * last.width, y: last.top + last.height + 18, "font-size": 12 };
        this.freshTicks.append(element("text", { ...at, "text-anchor": "middle", class: "sp-quiet" }, tick.label));
      }
    }
    reset() {
      this.across = [0, 1];
      for (const panel of this.panels) panel.part = [0, 1];
      this.show();
    }
    showSpikes() {
      for (const panel of this.panels) panel.part = panel.whole();
      this.show();
    }
    press(event) {
      const at = this.at(event);
      if (event.button !== 0 || event.pointerType === "touch" || !this.panelAt(at)) return;
      this.start = { at, panel: this.panelAt(at) };
      this.svg.setPointerCapture(event.pointerId);
      event.preventDefault();
    }
    // the part between the place that was pressed and this one; one that is hardly high leaves the y axis as it is
    dragged(at) {
      const { at: from, panel } = this.start;
      const within = (value, low, length) => Math.min(1, Math.max(0, (value - low) / length));
      const x = [from[0], at[0]].map((v) => within(v, panel.left, panel.width)).sort((a, b) => a - b);
      const isFlat = Math.abs(at[1] - from[1]) < 14;
      const y = isFlat ? [0, 1] : [from[1], at[1]].map((v) => 1 - within(v, panel.top, panel.height)).sort((a, b) => a - b);
      return { panel, x, y };
    }
    release(event) {
      if (!this.start) return;
      const at = this.at(event), { panel, x, y } = this.dragged(at);
      const isClick = Math.abs(at[0] - this.start.at[0]) < 6;
      this.start = undefined;
      this.box.setAttribute("visibility", "hidden");
      if (isClick) return;
      const inner = (part, [a, b]) => [part[0] + a * (part[1] - part[0]), part[0] + b * (part[1] - part[0])];
      const next = inner(this.across, x), high = inner(panel.part, y);
      if (next[1] - next[0] > MIN_PART) this.across = next;
      if (high[1] - high[0] > MIN_PART) panel.part = high;
      this.show();
    }
    leave() {
      if (this.start) return;
      this.cross.setAttribute("d", "");
      this.reading.style.display = "none";
    }
    move(event) {
      const at = this.at(event);
      if (this.start) {
        const { panel, x, y } = this.dragged(at);
        const box = { x: panel.left + x[0] * panel.width, y: panel.top + (1 - y[1]) * panel.height };
        const size = { width: (x[1] - x[0]) * panel.width, height: (y[1] - y[0]) * panel.height };
        for (const [key, value] of Object.entries({ ...box, ...size, visibility: "visible" })) this.box.setAttribute(key, value);
        return;
      }
      const panel = this.panelAt(at);
      if (!panel) return this.leave();
      const fraction = this.across[0] + ((at[0] - panel.left) / panel.width) * (this.across[1] - this.across[0]);
      const lines = this.panels.map((p) => `M${at[0]} ${p.top}v${p.height}`);
      this.cross.setAttribute("d", lines.join(""));
      this.read(panel, fraction, event);
    }
    // name of a curve; one of an error panel has the name of the curve of the same look
    nameOf(path) {
      if (path.dataset.name) return path.dataset.name;
      const look = (p) => `${p.getAttribute("class")} ${p.getAttribute("stroke-dasharray")}`;
      const all = this.panels.flatMap((panel) => panel.paths);
      return all.find((other) => other.dataset.name && look(other) === look(path))?.dataset.name || "";
    }
    read(panel, fraction, event) {
      const x = SPILL + fraction * panel.width;
      const unit = (text) => (text ? ` ${text}` : "");
      const { xUnit, unit: yUnit } = panel.clip.dataset;
      const head = document.createElement("b");
      head.textContent = written(panel.x, this.across, valueAt(panel.x, fraction)) + unit(xUnit);
      const rows = [head];
      for (const { path, points } of panel.curves()) {
        const y = ordinate(points, x);
        if (y === undefined) continue;
        const value = valueAt(panel.y, 1 - (y - SPILL) / panel.height);
        const row = document.createElement("div"), sample = document.createElement("i"), number = document.createElement("span");
        sample.style.borderTopColor = getComputedStyle(path).stroke;
        sample.style.borderTopStyle = path.getAttribute("stroke-dasharray") ? "dashed" : "solid";
        number.textContent = written(panel.y, panel.part, value) + unit(yUnit);
        row.append(sample, this.nameOf(path), " ", number);
        rows.push(row);
      }
      this.reading.replaceChildren(...rows);
      this.reading.style.display = "block";
      const around = this.svg.parentNode.getBoundingClientRect(), own = this.reading.getBoundingClientRect();
      const right = event.clientX - around.left + 16;
      const left = right + own.width > around.width ? event.clientX - around.left - own.width - 16 : right;
      const below = Math.min(event.clientY - around.top + 12, around.height - own.height);
      this.reading.style.left = `${Math.max(0, left)}px`;
      this.reading.style.top = `${Math.max(0, below)}px`;
    }
  }

  for (const svg of document.querySelectorAll("figure svg.sp")) {
    const clips = [...svg.querySelectorAll("svg[data-x]")];
    if (clips.length > 0) new Plot(svg, clips);
  }
  const figures = document.querySelector("#figures");
  if (figures) {
    const hint = document.createElement("p");
    hint.className = "key plot-hint";
    hint.textContent = "Move the pointer over a figure to read values, drag to magnify, double click for the whole figure.";
    figures.querySelector("h2")?.after(hint);
  }
})();
