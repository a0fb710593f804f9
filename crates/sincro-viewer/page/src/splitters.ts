// Borders between panels, to be dragged: widths and heights are variables of the page's style, kept by the browser.

import { el } from "./format";

interface Border {
  /** The variable, and the panel whose size it is. */
  name: "--left" | "--right" | "--below" | "--list";
  panel: string;
  label: string;
  isUpright: boolean;
  /** 1: the panel grows to the right; −1: to the left or upwards. */
  sign: 1 | -1;
}

const BORDERS: Border[] = [
  { name: "--left", panel: ".sv-objects", label: "width of the objects", isUpright: true, sign: 1 },
  { name: "--right", panel: ".sv-properties", label: "width of the properties", isUpright: true, sign: -1 },
  { name: "--below", panel: ".sv-below", label: "height of the plots", isUpright: false, sign: -1 },
  { name: "--list", panel: ".sv-signal-list", label: "width of the list of signals", isUpright: true, sign: 1 },
];

/** Least size of a panel, and of what lies beside it [px]. */
const LEAST = 90;
/** Width of what the mouse takes [px]. */
const GRIP = 7;
const KEY = "sincro-panels";

export function splitters(root: HTMLElement, changed: () => void): HTMLElement[] {
  const kept = stored();
  for (const [name, value] of Object.entries(kept)) root.style.setProperty(name, value);
  const made = BORDERS.map((border) => {
    const grip = el("div", { class: "sv-splitter", role: "separator", tabindex: "0", "aria-label": border.label, "aria-orientation": border.isUpright ? "vertical" : "horizontal", "data-border": border.name });
    grip.style.cursor = border.isUpright ? "col-resize" : "row-resize";
    const set = (size: number) => {
      const whole = border.isUpright ? root.clientWidth : root.clientHeight;
      const value = `${Math.round(Math.min(Math.max(size, LEAST), Math.max(LEAST, 0.75 * whole)))}px`;
      root.style.setProperty(border.name, value);
      kept[border.name] = value;
      store(kept);
      place();
      changed();
    };
    const size = () => {
      const box = root.querySelector(border.panel)?.getBoundingClientRect();
      return (border.isUpright ? box?.width : box?.height) ?? 0;
    };
    grip.addEventListener("pointerdown", (event) => {
      event.preventDefault();
      grip.setPointerCapture(event.pointerId);
      grip.classList.add("sv-held");
      const [from, before] = [border.isUpright ? event.clientX : event.clientY, size()];
      const move = (next: PointerEvent) => set(before + border.sign * ((border.isUpright ? next.clientX : next.clientY) - from));
      const end = () => {
        grip.classList.remove("sv-held");
        grip.removeEventListener("pointermove", move);
      };
      grip.addEventListener("pointermove", move);
      grip.addEventListener("pointerup", end, { once: true });
      grip.addEventListener("pointercancel", end, { once: true });
    });
    grip.addEventListener("keydown", (event) => {
      const steps: Record<string, number> = border.isUpright ? { ArrowLeft: -16, ArrowRight: 16 } : { ArrowUp: -16, ArrowDown: 16 };
      const by = steps[event.key];
      if (by === undefined) return;
      event.preventDefault();
      event.stopPropagation();
      set(size() + border.sign * by);
    });
    grip.addEventListener("dblclick", () => {
      root.style.removeProperty(border.name);
      delete kept[border.name];
      store(kept);
      place();
      changed();
    });
    return { border, grip };
  });
  const place = () => {
    const around = root.getBoundingClientRect();
    for (const { border, grip } of made) {
      const box = root.querySelector<HTMLElement>(border.panel)?.getBoundingClientRect();
      grip.hidden = !box || box.width === 0 || box.height === 0;
      if (!box) continue;
      const half = GRIP / 2;
      const [x, y] = [(border.sign > 0 ? box.right : box.left) - around.left, box.top - around.top];
      const style = border.isUpright ? { left: x - half, top: y, width: GRIP, height: box.height } : { left: 0, top: y - half, width: around.width, height: GRIP };
      for (const [key, value] of Object.entries(style)) grip.style.setProperty(key, `${value}px`);
    }
  };
  const watch = new ResizeObserver(place);
  watch.observe(root);
  // the panels are put into the page after this returns
  requestAnimationFrame(() => {
    for (const { border } of made) {
      const panel = root.querySelector(border.panel);
      if (panel) watch.observe(panel);
    }
    place();
  });
  return made.map(({ grip }) => grip);
}

function stored(): Record<string, string> {
  try {
    const known = JSON.parse(localStorage.getItem(KEY) ?? "{}") as Record<string, unknown>;
    const isSize = ([name, value]: [string, unknown]) => BORDERS.some((b) => b.name === name) && typeof value === "string" && /^\d+px$/.test(value);
    return Object.fromEntries(Object.entries(known).filter(isSize)) as Record<string, string>;
  } catch {
    return {};
  }
}

function store(sizes: Record<string, string>): void {
  try {
    localStorage.setItem(KEY, JSON.stringify(sizes));
  } catch {
    // a page from disk may have no store
  }
}
