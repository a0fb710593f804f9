// Objects that clients and scripts make while a run is on: shapes, sensors, dummies, drawings, particles.

import {
  BufferGeometry, DoubleSide, Float32BufferAttribute, Group, InstancedMesh, Line, LineBasicMaterial, LineSegments, Matrix4, Mesh,
  MeshBasicMaterial, MeshStandardMaterial, Object3D, OctahedronGeometry, Points, PointsMaterial, SphereGeometry, Vector3, type Material,
} from "three";
import type { DrawingView, Pose, RuntimeEvent, RuntimeView } from "../film";
import type { Run } from "../run";
import type { Bodies } from "./bodies";
import { geometry, poseMatrix, reach } from "./shapes";

const DUMMY = "#d55e00";
const VOLUME = "#009e73";
/** Segments of a ball around and from pole to pole. */
const ROUND: [number, number] = [12, 8];

/** An object that is there now. */
interface Present {
  node: Group;
  volume: Object3D | null;
  drawing: Items | null;
}

export class RuntimeObjects {
  private readonly present = new Map<number, Present>();
  /** Events that have been applied. */
  private n = 0;
  private t = -Infinity;

  constructor(private readonly run: Run, private readonly bodies: Bodies) {}

  /** Shows what is there at `t`. */
  place(t: number, hasVolumes: boolean): void {
    const { runtime } = this.run;
    if (t < this.t) this.clear();
    this.t = t;
    for (; this.n < runtime.length && (runtime[this.n] as RuntimeEvent).t <= t + 1e-12; this.n++) {
      this.apply(runtime[this.n] as RuntimeEvent);
    }
    for (const { volume, drawing } of this.present.values()) {
      if (volume) volume.visible = hasVolumes;
      drawing?.draw(t, this.run.view.gravity);
    }
  }

  /** How many objects are there now. */
  get count(): number {
    return this.present.size;
  }

  /** Forgets everything. */
  clear(): void {
    for (const id of [...this.present.keys()]) this.remove(id);
    this.n = 0;
    this.t = -Infinity;
  }

  private apply(event: RuntimeEvent): void {
    const known = this.present.get(event.id);
    if ("put" in event) {
      this.remove(event.id);
      this.add(event.id, event.put);
    } else if ("move" in event && known) this.hang(known.node, ...event.move);
    else if ("items" in event) known?.drawing?.set(...event.items);
    else if ("clear" in event) known?.drawing?.empty();
    else if ("gone" in event) this.remove(event.id);
  }

  private add(id: number, view: RuntimeView): void {
    const node = new Group();
    node.name = view.path;
    for (const shape of view.shapes) {
      const mesh = new Mesh(geometry(shape), new MeshStandardMaterial({ color: shape.color ?? DUMMY, roughness: 0.62, metalness: 0.05, side: DoubleSide }));
      mesh.applyMatrix4(poseMatrix(shape.pose));
      mesh.castShadow = true;
      mesh.receiveShadow = true;
      node.add(mesh);
    }
    let volume: Object3D | null = null;
    if (view.volume) {
      const points = view.volume.flat().map((p) => new Vector3(...p));
      volume = new LineSegments(new BufferGeometry().setFromPoints(points), new LineBasicMaterial({ color: VOLUME, transparent: true, opacity: 0.55 }));
      node.add(volume);
    }
    const drawing = view.drawing ? new Items(view.drawing) : null;
    if (drawing) node.add(drawing.root);
    // what has no extent is marked
    if (view.shapes.length === 0 && !drawing) {
      node.add(new Mesh(new OctahedronGeometry(0.02 * this.bodies.span), new MeshBasicMaterial({ color: DUMMY })));
    }
    this.hang(node, view.mover, view.pose);
    this.present.set(id, { node, volume, drawing });
  }

  private hang(node: Group, mover: number | null, pose: Pose): void {
    (this.bodies.movers[mover ?? this.bodies.view.n_movers] as Group).add(node);
    poseMatrix(pose).decompose(node.position, node.quaternion, node.scale);
  }

  private remove(id: number): void {
    const known = this.present.get(id);
    if (!known) return;
    known.node.traverse(dispose);
    known.node.removeFromParent();
    this.present.delete(id);
  }
}

/** Points of the world between which objects that stand there reach, over the whole run. */
export function corners(run: Run): Vector3[] {
  return run.runtime.flatMap((event) => {
    const [mover, pose, far] = "put" in event ? [event.put.mover, event.put.pose, Math.max(0, ...event.put.shapes.map(reach))]
      : "move" in event ? [event.move[0], event.move[1], 0] : [0, null, 0];
    if (mover !== null || pose === null) return [];
    return [-1, 1].map((sign) => new Vector3(pose[0], pose[1], pose[2]).addScalar(sign * far));
  });
}

function dispose(node: Object3D): void {
  if (!(node instanceof Mesh || node instanceof Line || node instanceof Points)) return;
  node.geometry.dispose();
  (node.material as Material).dispose();
  if (node instanceof InstancedMesh) node.dispose();
}

/** Items of a drawing. */
class Items {
  readonly root = new Group();
  private numbers = new Float32Array(0);
  private n = 0;
  /** The index behind the item that was written last: a list that goes round begins there. */
  private next = 0;
  private isStale = false;

  constructor(private readonly view: DrawingView) {}

  set(from: number, numbers: number[]): void {
    const { width } = this.view;
    const end = from * width + numbers.length;
    if (end > this.numbers.length) {
      const larger = new Float32Array(Math.max(end, 2 * this.numbers.length));
      larger.set(this.numbers);
      this.numbers = larger;
    }
    this.numbers.set(numbers, from * width);
    this.next = end / width;
    this.n = Math.max(this.n, this.next);
    this.isStale = true;
  }

  empty(): void {
    this.n = this.next = 0;
    this.isStale = true;
  }

  draw(t: number, gravity: [number, number, number]): void {
    if (this.view.kind === "particles") this.particles(t, gravity);
    else if (this.isStale) this.figures();
    this.isStale = false;
  }

  private figures(): void {
    const { kind, color, size, width } = this.view;
    if (kind === "balls") {
      this.balls(Array.from({ length: this.n }, (_, k) => new Vector3().fromArray(this.numbers, k * width)));
      return;
    }
    this.replace();
    if (this.n === 0) return;
    const used = this.numbers.subarray(0, this.n * width);
    const first = kind === "line_strip" ? this.next * width : 0;
    const shape = new BufferGeometry().setAttribute("position", new Float32BufferAttribute([...used.subarray(first), ...used.subarray(0, first)], 3));
    switch (kind) {
      case "points":
        this.root.add(new Points(shape, new PointsMaterial({ color, size: Math.max(2, size), sizeAttenuation: false })));
        break;
      case "lines":
        this.root.add(new LineSegments(shape, new LineBasicMaterial({ color })));
        break;
      case "line_strip":
        this.root.add(new Line(shape, new LineBasicMaterial({ color })));
        break;
      case "triangles":
        shape.computeVertexNormals();
        this.root.add(new Mesh(shape, new MeshStandardMaterial({ color, side: DoubleSide, roughness: 0.7 })));
    }
  }

  /** Those that are not older than their time are seen. */
  private particles(t: number, gravity: [number, number, number]): void {
    const { width, lifetime, falls } = this.view;
    const places: Vector3[] = [];
    // velocities are in the axes of the world: particles hang on nothing
    const fall = new Vector3(...gravity).multiplyScalar(falls ? 0.5 : 0);
    for (let k = 0; k < this.n; k++) {
      const at = k * width;
      const age = t - (this.numbers[at + 6] as number);
      if (age < -1e-6 || age > lifetime) continue;
      const place = new Vector3().fromArray(this.numbers, at);
      places.push(place.addScaledVector(new Vector3().fromArray(this.numbers, at + 3), age).addScaledVector(fall, age * age));
    }
    this.balls(places);
  }

  private balls(places: Vector3[]): void {
    let mesh = this.root.children[0] as InstancedMesh | undefined;
    if (!mesh || mesh.instanceMatrix.count < places.length) {
      this.replace();
      const room = Math.max(16, 2 * places.length);
      mesh = new InstancedMesh(new SphereGeometry(0.5 * this.view.size, ...ROUND), new MeshStandardMaterial({ color: this.view.color, roughness: 0.6 }), room);
      mesh.frustumCulled = false;
      this.root.add(mesh);
    }
    const matrix = new Matrix4();
    places.forEach((place, k) => (mesh as InstancedMesh).setMatrixAt(k, matrix.setPosition(place)));
    mesh.count = places.length;
    mesh.instanceMatrix.needsUpdate = true;
  }

  private replace(): void {
    for (const old of [...this.root.children]) {
      dispose(old);
      old.removeFromParent();
    }
  }
}
