// Numbers and elements: sensible digits, real minus signs, text that is never markup.

/** A number for the eye: `digits` significant ones, `−0.0123`, `1.2·10⁻⁷`. */
export function format(x: number | null | undefined, digits = 4): string {
  if (x === null || x === undefined) return "–";
  if (!Number.isFinite(x)) return Number.isNaN(x) ? "not a number" : x > 0 ? "∞" : "−∞";
  if (x === 0) return "0";
  const size = Math.abs(x);
  if (size >= 1e6 || size < 1e-4) {
    const [mantissa, exponent] = x.toExponential(digits - 1).split("e") as [string, string];
    const raised = exponent.replace("+", "").replace(/[-0-9]/g, (c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)] as string);
    const short = mantissa.includes(".") ? mantissa.replace(/0+$/, "").replace(/\.$/, "") : mantissa;
    return `${short}·10${raised}`.replace("-", "−");
  }
  const decimals = Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return x.toFixed(Math.min(decimals, 12)).replace("-", "−");
}

/** A round number without zeros at its end: for axes and for what stands in files. */
export function plain(x: number): string {
  return x !== 0 && (Math.abs(x) >= 1e6 || Math.abs(x) < 1e-4) ? format(x, 6) : String(+x.toPrecision(9)).replace("-", "−");
}

/** As many digits as bring the number back. */
export function exact(x: number): string {
  return String(x);
}

/** Whether the reader wants a dark page. */
export function isDark(): boolean {
  return matchMedia("(prefers-color-scheme: dark)").matches;
}

type Child = Node | string | null;
type Props = Record<string, string | number | boolean | ((event: Event) => void) | null>;

/** An element: keys that start with `on` are listeners, `class` and others attributes, `text` its text. */
export function el<K extends keyof HTMLElementTagNameMap>(tag: K, props: Props = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const node = document.createElement(tag);
  for (const [key, value] of Object.entries(props)) {
    if (value === null || value === false) continue;
    if (typeof value === "function") node.addEventListener(key.slice(2), value);
    else if (key === "text") node.textContent = String(value);
    else node.setAttribute(key, value === true ? "" : String(value));
  }
  for (const child of children) if (child !== null) node.append(child);
  return node;
}

/** Hands a text or picture to the reader as a file. */
export function save(name: string, content: Blob): void {
  const url = URL.createObjectURL(content);
  const link = el("a", { href: url, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

/** 1, 2 or 5 times a power of ten near `x`. */
export function nice(x: number): number {
  const power = 10 ** Math.floor(Math.log10(x));
  const lead = x / power;
  return power * (lead < 1.5 ? 1 : lead < 3.5 ? 2 : lead < 7.5 ? 5 : 10);
}
