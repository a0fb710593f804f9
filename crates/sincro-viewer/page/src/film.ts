// What the server and the report send: the shapes of the data, and how numbers come out of base 64.

/** Position [m], then quaternion x, y, z, w. */
export type Pose = [number, number, number, number, number, number, number];

export interface ShapeView {
  kind: "cuboid" | "sphere" | "cylinder" | "capsule" | "cone" | "plane" | "mesh";
  /** Edge lengths of a cuboid; radius and length of the others [m]; nothing for planes and meshes. */
  size: number[];
  /** Corners [m] and triangles of a mesh. */
  vertices?: [number, number, number][];
  triangles?: [number, number, number][];
  pose: Pose;
  color: string | null;
}

export interface JointView {
  base_mover: number | null;
  base_pose: Pose;
  axes: [number, number, number][];
  q_idx: number;
  n_q: number;
  v_idx: number;
  n_v: number;
  springs: [number, number, number][];
  motor: boolean;
}

export interface RotorView {
  index: number;
  radius: number | null;
  is_ccw: boolean;
}

export interface ObjectView {
  path: string;
  name: string;
  kind: string;
  parent: number | null;
  mover: number | null;
  pose: Pose;
  shapes: ShapeView[];
  mass: [number, [number, number, number], [number, number, number, number, number, number]] | null;
  joint: JointView | null;
  rotor: RotorView | null;
  force: number | null;
  drag: number | null;
  /** Edges of the volume that a proximity sensor sees, in its frame [m]. */
  volume?: [[number, number, number], [number, number, number]][];
  /** Looks along z of its frame, y is up in the picture. */
  camera?: { field_of_view_deg: number };
  /** Of a closure: mover and pose of its other end. */
  other_end?: [number | null, Pose];
  /** Of a spring-damper or tendon: mover of each of its points, and position there [m]. */
  line?: [number | null, [number, number, number]][];
}

export interface SceneView {
  objects: ObjectView[];
  n_movers: number;
  n_rotors: number;
  n_forces: number;
  n_drags: number;
  /** Movers at which the frames have the wind. */
  winds: number[];
  /** Object of each surface that can touch. */
  surfaces: (number | null)[];
  n_q: number;
  n_v: number;
  gravity: [number, number, number];
}

export interface Property {
  owner: string;
  path: string;
  key: string;
  value: number;
  unit: string;
  about: string;
}

/** Items of a drawing that was made at run time. */
export interface DrawingView {
  kind: "points" | "balls" | "lines" | "line_strip" | "triangles" | "particles";
  /** Numbers of an item: positions [m]; of a particle position, velocity [m/s], time [s]. */
  width: number;
  /** Diameter of a ball or particle [m]; of a point, and width of a line, [pixel]. */
  size: number;
  color: string;
  /** How long a particle is seen [s]. */
  lifetime: number;
  falls: boolean;
}

/** Object that a client or script has made. */
export interface RuntimeView {
  path: string;
  kind: string;
  mover: number | null;
  pose: Pose;
  shapes: ShapeView[];
  volume?: NonNullable<ObjectView["volume"]>;
  drawing?: DrawingView;
}

/** Change at `t` [s] of an object that was made at run time. */
export type RuntimeEvent = { t: number; id: number } & (
  | { put: RuntimeView }
  | { move: [number | null, Pose] }
  | { items: [number, number[]] }
  | { clear: null }
  | { gone: null }
);

export interface Reel {
  name: string;
  about: string;
  view: number;
  stop: string;
  trace: string;
  frames: { width: number; times: string; numbers: string; counts: string; contacts: string };
  signals: {
    every: number;
    columns: [string, string, number | null][];
    times: string;
    numbers: string;
    references: [string, string, string][];
  };
  runtime?: RuntimeEvent[];
  runtime_is_cut?: boolean;
}

export interface Film {
  format: string;
  title: string;
  description: string;
  scene: string;
  step: number;
  duration: number;
  views: SceneView[];
  properties: Property[];
  plots: [string, string[]][];
  /** Signals that the experiment records. */
  record?: string[];
  diagram: string | null;
  runs: Reel[];
  /** All runs are drawn over each other from the start. */
  overlaid?: boolean;
}

function bytes(text: string): Uint8Array<ArrayBuffer> {
  const raw = atob(text);
  const out = new Uint8Array(raw.length);
  for (let k = 0; k < raw.length; k++) out[k] = raw.charCodeAt(k);
  return out;
}

export function doubles(text: string): Float64Array<ArrayBuffer> {
  return new Float64Array(bytes(text).buffer);
}

export function singles(text: string): Float32Array<ArrayBuffer> {
  return new Float32Array(bytes(text).buffer);
}

/** Reads a film; throws a sentence if it is none of ours. */
export function readFilm(text: string): Film {
  const film = JSON.parse(text) as Film;
  if (film.format !== "sincro-film-2") throw new Error(`this is not a replay that this page can show (format ${String(film.format)})`);
  return film;
}
