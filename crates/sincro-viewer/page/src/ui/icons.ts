// Small pictures of the kinds of objects; drawn, because fonts lack such signs.

/** Strokes on a field of 16 × 16; what begins with `.` is filled. */
const SHAPES: Record<string, string> = {
  body: ".M3 5.5 8 3l5 2.5v5.6L8 13.6l-5-2.5z",
  fixture: "M2 10h12M3.5 10l-1.5 3M7 10l-1.5 3M10.5 10 9 13M14 10l-1.5 3",
  frame: "M4 12V3M4 12h9M4 12l4-4",
  force: "M2 14 12 4M12 4H7M12 4v5",
  rotor: "M8 8c-4-4-6-2-6 0s2 1 6 0c4 4 6 2 6 0s-2-1-6 0z",
  drag: "M2 5c2-2 4 2 6 0s4 2 6 0M2 10c2-2 4 2 6 0s4 2 6 0",
  sensor: "M8 8m-2 0a2 2 0 1 0 4 0a2 2 0 1 0-4 0M4 4a5.6 5.6 0 0 0 0 8M12 4a5.6 5.6 0 0 1 0 8",
  camera: "M2 5h7v6H2zM9 8l5-3v6z",
  coupling: "M5 8m-3 0a3 3 0 1 0 6 0a3 3 0 1 0-6 0M11 8m-3 0a3 3 0 1 0 6 0a3 3 0 1 0-6 0",
  closure: "M6.5 9.5a2.6 2.6 0 0 1 0-3.7l2-2a2.6 2.6 0 0 1 3.7 3.7l-1 1M9.5 6.5a2.6 2.6 0 0 1 0 3.7l-2 2a2.6 2.6 0 0 1-3.7-3.7l1-1",
  prismatic: "M2 6h12M2 10h12M6 4.5v7h4v-7z",
  fixed: "M4 4l8 8M12 4l-8 8",
  joint: "M8 8m-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0M8 8m-1 0a1 1 0 1 0 2 0a1 1 0 1 0-2 0",
};

/** The picture of a kind such as `revolute joint`. */
export function icon(kind: string): SVGSVGElement {
  const [first, last] = [kind.split(" ")[0] as string, kind.split(" ").at(-1) as string];
  const shape = SHAPES[first] ?? SHAPES[last] ?? (SHAPES["joint"] as string);
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  const path = document.createElementNS("http://www.w3.org/2000/svg", "path");
  svg.setAttribute("viewBox", "0 0 16 16");
  svg.setAttribute("class", shape.startsWith(".") ? "sv-icon sv-filled" : "sv-icon");
  svg.setAttribute("aria-hidden", "true");
  path.setAttribute("d", shape.replace(".M", "M"));
  svg.append(path);
  return svg;
}
