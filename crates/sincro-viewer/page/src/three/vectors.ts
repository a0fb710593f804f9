// Forces and wind as arrows: thrust, external forces, drag, contact, and the points where bodies touch.

import { Mesh, MeshBasicMaterial, SphereGeometry, Vector3, type Material, type Object3D, type Scene } from "three";
import { format, isDark } from "../format";
import { CONTACT } from "../run";
import type { Session, Shown } from "../session";
import { Arrow } from "./arrow";
import type { Bodies } from "./bodies";

/** Of contact, on a light page and on a dark one. */
const POINT = ["#a5127d", "#f07cc6"] as const;
/** Values that are looked at to find how long arrows are. */
const SAMPLES = 4000;

interface Kind {
  key: Shown;
  name: string;
  unit: string;
  color: string;
  /** Length, by the size of the mechanism, of an arrow that is as long as nearly all of its kind. */
  share: number;
  /** Calls `show` for each arrow at `t`: from where, and how much. */
  read: (t: number, show: (from: Vector3, vector: Vector3) => void) => void;
}

interface Made extends Kind {
  arrows: Arrow[];
  /** What is drawn at full length. */
  full: number;
  /** The largest one now. */
  now: number;
}

export class Vectors {
  private kinds: Made[] = [];
  private points: Mesh[] = [];
  private bodies: Bodies | null = null;

  constructor(private readonly session: Session, private readonly scene: Scene) {}

  /** Everything anew, for what is shown now. */
  rebuild(bodies: Bodies): void {
    const drop = (node: Object3D) => {
      node.traverse((part) => {
        if (!(part instanceof Mesh)) return;
        part.geometry.dispose();
        (part.material as Material).dispose();
      });
      node.removeFromParent();
    };
    this.kinds.forEach((kind) => kind.arrows.forEach(drop));
    this.points.splice(0).forEach(drop);
    this.bodies = bodies;
    const { shown } = this.session;
    this.kinds = this.all(bodies).filter(({ key }) => shown[key]).map((kind) => ({ ...kind, arrows: [], full: this.usual(kind), now: 0 }));
  }

  place(t: number): void {
    const { bodies } = this;
    if (!bodies || this.session.run.times.n === 0) return;
    for (const kind of this.kinds) {
      let n = 0;
      kind.now = 0;
      kind.read(t, (from, vector) => {
        const size = vector.length();
        if (!(size > 0) || !Number.isFinite(size)) return;
        kind.now = Math.max(kind.now, size);
        kind.full = Math.max(kind.full, size / 4);
        const arrow = (kind.arrows[n] ??= this.arrow(kind.color, bodies.span));
        arrow.set(from, vector.divideScalar(size), kind.share * bodies.span * Math.min(size / kind.full, 1.5));
        n++;
      });
      for (let k = n; k < kind.arrows.length; k++) (kind.arrows[k] as Arrow).visible = false;
    }
    this.placePoints(t, bodies.span);
  }

  /** Colour and words for what is drawn. */
  get legend(): [color: string, words: string][] {
    return this.kinds.filter(({ now }) => now > 0).map(({ color, name, now, unit }) => [color, `${name}, largest now ${format(now, 3)} ${unit}`]);
  }

  private arrow(color: string, size: number): Arrow {
    const arrow = new Arrow(color, size);
    this.scene.add(arrow);
    return arrow;
  }

  private all(bodies: Bodies): Kind[] {
    const { session } = this;
    const { view } = session;
    const at = new Vector3();
    const vector = new Vector3();
    const objects = view.objects.map((object, k) => ({ object, k }));
    const rotors = objects.flatMap(({ object, k }) => (object.rotor ? [{ rotor: object.rotor.index, k }] : []));
    const forces = objects.flatMap(({ object, k }) => (object.force === null ? [] : [{ force: object.force, k }]));
    const drags = objects.flatMap(({ object, k }) => (object.drag === null ? [] : [{ drag: object.drag, k }]));
    const zero = new Vector3();
    const kinds: Kind[] = [
      { key: "rotors", name: "thrust", unit: "N", color: "#009e73", share: 0.32, read: (t, show) => rotors.forEach(({ rotor, k }) => {
        const node = bodies.nodes[k] as Object3D;
        vector.set(0, 0, 1).transformDirection(node.matrixWorld).multiplyScalar(session.run.rotor(t, rotor, 1));
        show(bodies.position(k, at), vector);
      }) },
      { key: "forces", name: "external force", unit: "N", color: "#d55e00", share: 0.7, read: (t, show) => forces.forEach(({ force, k }) => show(bodies.position(k, at), vector.set(...session.run.force(t, force)))) },
      { key: "drags", name: "drag", unit: "N", color: "#a67c00", share: 0.5, read: (t, show) => drags.forEach(({ drag, k }) => show(bodies.position(k, at), vector.set(...session.run.drag(t, drag)))) },
      { key: "contactForces", name: "contact force", unit: "N", color: POINT[isDark() ? 1 : 0], share: 0.45, read: (t, show) => this.contacts(t, at, vector, show) },
      { key: "wind", name: "wind", unit: "m/s", color: "#3a9bd9", share: 0.8, read: (t, show) => view.winds.forEach((mover, k) => show(bodies.movers[mover]?.getWorldPosition(at) ?? zero, vector.set(...session.run.wind(t, k)))) },
    ];
    return kinds;
  }

  /** Contact forces at `t`, each on the body that is selected or that moves; of two that do, on the first. */
  private contacts(t: number, at: Vector3, force: Vector3, show: (from: Vector3, vector: Vector3) => void): void {
    const { run, selected, view } = this.session;
    const { from, to } = run.contactsAt(t);
    const object = (row: number, c: number) => view.surfaces[run.contacts.at(row, c)] ?? null;
    const moves = (k: number | null) => k !== null && view.objects[k]?.mover !== null;
    for (let row = from; row < to; row++) {
      const read = (c: number) => run.contacts.at(row, c);
      force.set(read(5), read(6), read(7));
      const [first, second] = [object(row, 0), object(row, 1)];
      const onSecond = second !== null && (second === selected || (first !== selected && !moves(first) && moves(second)));
      if (onSecond) force.negate();
      show(at.set(read(2), read(3), read(4)), force);
    }
  }

  /** What is drawn at full length: what all but the rarest peaks of the run stay below. */
  private usual(kind: Kind): number {
    const { run } = this.session;
    const sizes: number[] = [];
    if (kind.key === "contactForces") {
      const rows = run.contacts.view();
      const every = CONTACT * Math.max(1, Math.ceil(run.contacts.n / SAMPLES));
      for (let k = 0; k < rows.length; k += every) sizes.push(Math.hypot(rows[k + 5] as number, rows[k + 6] as number, rows[k + 7] as number));
    } else {
      const every = Math.max(1, Math.ceil(run.times.n / SAMPLES));
      for (let k = 0; k < run.times.n; k += every) kind.read(run.times.at(k, 0), (_, vector) => sizes.push(vector.length()));
    }
    const sorted = sizes.filter((size) => size > 0 && Number.isFinite(size)).sort((a, b) => a - b);
    return sorted[Math.floor(0.98 * (sorted.length - 1))] ?? 1e-9;
  }

  private placePoints(t: number, size: number): void {
    const { run, shown } = this.session;
    const { from, to } = shown.contacts ? run.contactsAt(t) : { from: 0, to: 0 };
    for (let k = 0; k < Math.max(to - from, this.points.length); k++) {
      const point = (this.points[k] ??= this.point(size));
      point.visible = k < to - from;
      if (point.visible) point.position.set(run.contacts.at(from + k, 2), run.contacts.at(from + k, 3), run.contacts.at(from + k, 4));
    }
  }

  private point(size: number): Mesh {
    const ball = new Mesh(new SphereGeometry(0.013 * size, 16, 10), new MeshBasicMaterial({ color: POINT[isDark() ? 1 : 0], depthTest: false, transparent: true }));
    ball.renderOrder = 7;
    this.scene.add(ball);
    return ball;
  }
}
