// One run's bodies in the picture: a group a mover, meshes in it, sticks between joints where there are no shapes.

import {
  BoxGeometry, CircleGeometry, CylinderGeometry, DoubleSide, EdgesGeometry, Group, LineBasicMaterial, LineSegments, Mesh, MeshBasicMaterial, MeshStandardMaterial, Object3D, Quaternion,
  RingGeometry, SphereGeometry, Vector3, type BufferGeometry,
} from "three";
import { isDark } from "../format";
import type { ObjectView, Pose, SceneView, ShapeView } from "../film";
import type { Run } from "../run";
import { geometry, inertiaBox, poseMatrix, reach } from "./shapes";

/** Colours of bodies without one of their own, to be told apart by all eyes. */
const COLORS = ["#5b7f9e", "#c98a3c", "#5f9e83", "#a8748f", "#8a8f98", "#b5a642"];
/** Kinds that are shown by no stick. */
const MARKS = new Set(["force", "frame", "drag", "sensor", "camera"]);
const STICK = "#7d8590";
const SELECTED = "#f0a500";
const ROTOR = "#2f6f9f";
const ROTOR_DARK = "#6fb1e0";

export class Bodies {
  readonly root = new Group();
  /** One group a mover; the last one is the world. */
  readonly movers: Group[] = [];
  /** One a object: where its frame is. */
  readonly nodes: Object3D[] = [];
  readonly size: number;
  /** What all that moves takes up at the start, about [m]: how large arrows are, how near cameras stand. */
  span: number;
  private outline: LineSegments[] = [];
  private readonly blades: { node: Object3D; rotor: number; sign: number }[] = [];
  private readonly meshes: Mesh[] = [];
  /** Pieces of planes, 1 m × 1 m until the picture says how large they are. */
  readonly planes: Mesh[] = [];

  constructor(readonly view: SceneView, private readonly isGhost: boolean) {
    for (let k = 0; k <= view.n_movers; k++) {
      const group = new Group();
      this.movers.push(group);
      this.root.add(group);
    }
    this.size = extent(view);
    this.span = this.size;
    view.objects.forEach((object, k) => this.add(object, k));
    view.objects.forEach((object, k) => this.stick(object, k));
  }

  /** Puts everything where it is at `t` of a run. */
  place(run: Run, t: number): void {
    if (run.times.n === 0) return;
    const { k, share } = run.locate(t);
    const [p, q, r] = [new Vector3(), new Quaternion(), new Quaternion()];
    for (let m = 0; m < this.view.n_movers; m++) {
      const at = (row: number, c: number) => run.frames.at(row, 7 * m + c);
      const group = this.movers[m] as Group;
      group.position.set(at(k, 0), at(k, 1), at(k, 2));
      group.quaternion.set(at(k, 3), at(k, 4), at(k, 5), at(k, 6)).normalize();
      if (share > 0) {
        p.set(at(k + 1, 0), at(k + 1, 1), at(k + 1, 2));
        r.set(at(k + 1, 3), at(k + 1, 4), at(k + 1, 5), at(k + 1, 6)).normalize();
        group.position.lerp(p, share);
        q.copy(group.quaternion).slerp(r, share);
        group.quaternion.copy(q);
      }
    }
    for (const { node, rotor, sign } of this.blades) {
      // a fiftieth of the speed: the eye sees which way it turns, and whether
      node.rotation.z = (sign * t * run.rotor(t, rotor, 0)) / 50;
    }
  }

  /** Where an object is in the world. */
  position(object: number, out = new Vector3()): Vector3 {
    return (this.nodes[object] as Object3D).getWorldPosition(out);
  }

  highlight(selected: number | null, hovered: number | null): void {
    for (const old of this.outline.splice(0)) {
      old.geometry.dispose();
      (old.material as LineBasicMaterial).dispose();
      old.removeFromParent();
    }
    for (const mesh of this.meshes) {
      const material = mesh.material as MeshStandardMaterial;
      if (!("emissive" in material)) continue;
      const object = mesh.userData["object"] as number;
      material.emissive.set(object === selected ? SELECTED : object === hovered ? "#8899aa" : "#000000");
      material.emissiveIntensity = object === selected ? 0.16 : 0.22;
      if (object !== selected) continue;
      const edges = new LineSegments(new EdgesGeometry(mesh.geometry, 35), new LineBasicMaterial({ color: SELECTED }));
      mesh.add(edges);
      this.outline.push(edges);
    }
  }

  /** Meshes that a click may hit. */
  get targets(): Mesh[] {
    return this.meshes;
  }

  dispose(): void {
    this.root.traverse((node) => {
      if (node instanceof Mesh) {
        (node.geometry as BufferGeometry).dispose();
        (node.material as MeshStandardMaterial).dispose();
      }
    });
    this.root.removeFromParent();
  }

  private carrier(mover: number | null): Group {
    return this.movers[mover ?? this.view.n_movers] as Group;
  }

  private add(object: ObjectView, k: number): void {
    const node = new Object3D();
    node.applyMatrix4(poseMatrix(object.pose));
    this.carrier(object.mover).add(node);
    this.nodes.push(node);
    const color = COLORS[this.view.objects.slice(0, k).filter((o) => o.kind === "body").length % COLORS.length] as string;
    for (const shape of object.shapes) {
      if (shape.kind === "plane") {
        this.plane(shape, node, k);
        continue;
      }
      const mesh = this.mesh(geometry(shape), shape.color ?? color, k);
      mesh.applyMatrix4(poseMatrix(shape.pose));
      node.add(mesh);
    }
    if (object.mass && object.shapes.length === 0 && object.mass[0] > 0) {
      const [mass, center, inertia] = object.mass;
      const box = inertiaBox(mass, inertia);
      const most = 0.6 * this.size;
      const mesh = this.mesh(new BoxGeometry(...box.size.clampScalar(0.01 * this.size, most).toArray()), color, k);
      mesh.position.set(...center);
      mesh.quaternion.copy(box.rotation);
      node.add(mesh);
    }
    if (object.rotor) this.rotor(object, node, k);
  }

  /** Planes are no targets: a click beside the bodies selects nothing. */
  private plane(shape: ShapeView, node: Object3D, k: number): void {
    if (this.isGhost) return;
    const material = new MeshStandardMaterial({ color: shape.color ?? (isDark() ? "#232a31" : "#f1f3f5"), roughness: 0.95, side: DoubleSide, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    const mesh = new Mesh(geometry(shape), material);
    mesh.applyMatrix4(poseMatrix(shape.pose));
    mesh.receiveShadow = true;
    mesh.userData["object"] = k;
    mesh.userData["node"] = node;
    node.add(mesh);
    this.planes.push(mesh);
  }

  private rotor(object: ObjectView, node: Object3D, k: number): void {
    const rotor = object.rotor as NonNullable<ObjectView["rotor"]>;
    const radius = rotor.radius ?? 0.12 * this.size;
    const color = isDark() ? ROTOR_DARK : ROTOR;
    const disc = new Mesh(
      new CircleGeometry(radius, 48),
      new MeshBasicMaterial({ color, transparent: true, opacity: this.isGhost ? 0.06 : 0.16, side: DoubleSide, depthWrite: false }),
    );
    disc.userData["object"] = k;
    const rim = new Mesh(
      new RingGeometry(0.97 * radius, radius, 64),
      new MeshBasicMaterial({ color, transparent: true, opacity: this.isGhost ? 0.2 : 0.7, side: DoubleSide }),
    );
    const blades = new Group();
    blades.add(this.mesh(new BoxGeometry(1.9 * radius, 0.1 * radius, 0.015 * radius), color, k));
    node.add(disc, rim, blades, this.mesh(new CylinderGeometry(0.07 * radius, 0.09 * radius, 0.16 * radius, 20).rotateX(Math.PI / 2), STICK, k));
    this.meshes.push(disc);
    this.blades.push({ node: blades, rotor: rotor.index, sign: rotor.is_ccw ? 1 : -1 });
  }

  /** A stick from what carries an object, where no shape shows how they hang together. */
  private stick(object: ObjectView, k: number): void {
    const parent = object.parent === null ? null : (this.view.objects[object.parent] as ObjectView);
    const hasShapes = parent !== null && (parent.shapes.length > 0 || (parent.kind !== "body" && this.hasShapeNear(object.parent as number)));
    if (parent === null || hasShapes || MARKS.has(object.kind)) return;
    const mover = object.joint ? object.joint.base_mover : object.mover;
    const [from, to] = [(parent.pose), object.joint ? object.joint.base_pose : object.pose];
    if (parent.mover !== mover || this.isFree(object)) return;
    this.bar(this.carrier(mover), from, to, k);
  }

  private isFree(object: ObjectView): boolean {
    return object.joint !== null && object.joint.axes.length === 0;
  }

  private hasShapeNear(index: number): boolean {
    return this.view.objects.some((o) => o.parent === index && o.shapes.length > 0);
  }

  private bar(carrier: Group, from: Pose, to: Pose, k: number): void {
    const [a, b] = [new Vector3(from[0], from[1], from[2]), new Vector3(to[0], to[1], to[2])];
    const length = a.distanceTo(b);
    if (length < 1e-6) return;
    const radius = 0.009 * this.size;
    const mesh = this.mesh(new CylinderGeometry(radius, radius, length, 12), STICK, k);
    mesh.position.copy(a).lerp(b, 0.5);
    mesh.quaternion.setFromUnitVectors(new Vector3(0, 1, 0), b.sub(a).normalize());
    const knob = this.mesh(new SphereGeometry(1.5 * radius, 14, 10), STICK, k);
    knob.position.set(to[0], to[1], to[2]);
    carrier.add(mesh, knob);
  }

  private mesh(shape: BufferGeometry, color: string, object: number): Mesh {
    const material = this.isGhost
      ? new MeshStandardMaterial({ color, transparent: true, opacity: 0.22, depthWrite: false, roughness: 0.9 })
      : new MeshStandardMaterial({ color, roughness: 0.62, metalness: 0.05 });
    const mesh = new Mesh(shape, material);
    mesh.castShadow = !this.isGhost;
    mesh.receiveShadow = !this.isGhost;
    mesh.userData["object"] = object;
    if (!this.isGhost) this.meshes.push(mesh);
    return mesh;
  }
}

/** About how large the mechanism is [m]: what its offsets and shapes span. */
export function extent(view: SceneView): number {
  let size = 0;
  for (const object of view.objects) {
    if (object.camera || object.other_end) continue;
    const pose = object.joint ? object.joint.base_pose : object.pose;
    size = Math.max(size, Math.hypot(pose[0], pose[1], pose[2]) + (object.rotor?.radius ?? 0));
    for (const shape of object.shapes) size = Math.max(size, Math.hypot(shape.pose[0], shape.pose[1], shape.pose[2]) + reach(shape));
    if (object.mass) size = Math.max(size, Math.sqrt(Math.max(...object.mass[2].map(Math.abs)) / Math.max(object.mass[0], 1e-9)));
  }
  return size > 0 ? size : 1;
}
