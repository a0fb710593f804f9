// The object tree: search, select, fold.

import { el } from "../format";
import type { Session } from "../session";
import { icon } from "./icons";

export function tree(session: Session): HTMLElement {
  const list = el("ul", { class: "sv-tree", role: "tree", "aria-label": "Objects" });
  const search = el("input", { type: "search", placeholder: "search objects", "aria-label": "search objects", oninput: () => draw() });
  const folded = new Set<number>();

  const draw = () => {
    const { objects } = session.view;
    const wanted = search.value.trim().toLowerCase();
    const depths = objects.map(() => 0);
    const items: HTMLElement[] = [];
    objects.forEach((object, k) => {
      depths[k] = object.parent === null ? 0 : (depths[object.parent] as number) + 1;
      if (wanted ? !object.path.toLowerCase().includes(wanted) : isHidden(k)) return;
      const hasChildren = objects.some((o) => o.parent === k);
      const isSelected = session.selected === k;
      const fold = el("button", {
        class: "sv-fold", tabindex: "-1", "aria-label": folded.has(k) ? "unfold" : "fold", text: hasChildren && !wanted ? (folded.has(k) ? "▸" : "▾") : "",
        onclick: (event) => {
          event.stopPropagation();
          if (!folded.delete(k)) folded.add(k);
          draw();
        },
      });
      items.push(
        el("li", {
          role: "treeitem", "aria-selected": String(isSelected), "data-path": object.path, class: isSelected ? "sv-selected" : "", title: `${object.path}: ${object.kind}`,
          tabindex: "0", style: `--depth: ${wanted ? 0 : (depths[k] as number)}`, onclick: () => session.select(k),
          onkeydown: (event) => {
            if ((event as KeyboardEvent).key === "Enter") session.select(k);
          },
        }, fold, icon(object.kind), el("span", { class: "sv-name" }, el("bdi", { text: wanted ? object.path : object.name }))),
      );
    });
    // deep trees are indented less
    list.style.setProperty("--indent", `${Math.max(4, Math.min(14, 100 / Math.max(1, ...depths)))}px`);
    list.replaceChildren(...items);
  };
  const isHidden = (k: number): boolean => {
    for (let at = session.view.objects[k]?.parent ?? null; at !== null; at = session.view.objects[at]?.parent ?? null) if (folded.has(at)) return true;
    return false;
  };
  session.on("runs", draw);
  session.on("selection", draw);
  draw();
  return el("section", { class: "sv-panel sv-objects" }, el("h3", { text: "Objects" }), search, list);
}
