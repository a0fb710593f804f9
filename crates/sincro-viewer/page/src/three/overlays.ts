// What is drawn over the bodies on wish: axes, centres of mass, boxes of inertia, frames, springs, tendons, closures, cameras,
// paths.

import {
  AxesHelper, BoxGeometry, BufferGeometry, CatmullRomCurve3, CylinderGeometry, EdgesGeometry, Float32BufferAttribute, Group, Line, LineBasicMaterial,
  LineSegments, Mesh, MeshBasicMaterial, Object3D, SphereGeometry, TorusGeometry, TubeGeometry, Vector3, type Material, type Scene,
} from "three";
import type { ObjectView } from "../film";
import type { Session } from "../session";
import { Arrow } from "./arrow";
import type { Bodies } from "./bodies";
import { inertiaBox, poseMatrix } from "./shapes";

const AXIS = "#d55e00";
const CENTER = "#cc79a7";
const SPRING = "#b58900";
const CLOSURE = "#7a3e9d";
const PATH = "#0072b2";
const VOLUME = "#009e73";

/** Mover, and position in its frame [m]. */
type LinePoint = NonNullable<ObjectView["line"]>[number];

export class Overlays {
  private readonly made: Object3D[] = [];
  /** Straight pieces of springs and tendons with the two points that each joins. */
  private readonly pieces: { piece: Mesh; ends: [LinePoint, LinePoint] }[] = [];

  /** The camera through which one looks: it is not drawn. */
  through: number | null = null;

  constructor(private readonly session: Session, private readonly scene: Scene) {}

  /** Everything anew, for what is shown now. */
  rebuild(bodies: Bodies): void {
    for (const old of this.made.splice(0)) {
      old.traverse((node) => {
        if (node instanceof Mesh || node instanceof Line) {
          node.geometry.dispose();
          (node.material as Material).dispose();
        }
      });
      old.removeFromParent();
    }
    this.pieces.length = 0;
    const { shown, view } = this.session;
    view.objects.forEach((object, k) => {
      const node = bodies.nodes[k] as Object3D;
      if (shown.axes && object.joint) this.jointAxes(object, bodies);
      if (object.mass && shown.centers) this.hang(node, this.center(object, bodies.size));
      if (object.mass && shown.inertia) this.hang(node, this.box(object));
      if (k === this.through) return;
      if (shown.frames && object.kind !== "force" && object.kind !== "coupling") this.frame(node, 0.12 * bodies.size);
      if (shown.springs && object.joint) this.springs(object, node, bodies.size);
      if (shown.springs && object.line) this.line(object.line, bodies);
      if (shown.closures && object.other_end) this.closure(object, bodies);
      if (shown.volumes && object.volume) this.volume(node, object.volume);
      if (shown.frames && object.camera) this.camera(node, object.camera.field_of_view_deg, bodies.size);
    });
    if (shown.trace && this.session.selected !== null) this.path(this.session.selected, bodies);
    this.place(bodies);
  }

  /** Puts springs and tendons where their points are now. */
  place(bodies: Bodies): void {
    const [up, from, to] = [new Vector3(0, 1, 0), new Vector3(), new Vector3()];
    const put = ([mover, position]: LinePoint, out: Vector3) => {
      const carrier = bodies.movers[mover ?? bodies.view.n_movers] as Group;
      carrier.updateMatrix();
      out.set(...position).applyMatrix4(carrier.matrix);
    };
    for (const { piece, ends } of this.pieces) {
      put(ends[0], from);
      put(ends[1], to);
      piece.position.copy(from).add(to).multiplyScalar(0.5);
      to.sub(from);
      piece.visible = to.length() > 0;
      piece.scale.set(1, to.length(), 1);
      piece.quaternion.setFromUnitVectors(up, to.normalize());
    }
  }

  private hang(node: Object3D, what: Object3D): void {
    node.add(what);
    this.made.push(what);
  }

  private jointAxes(object: ObjectView, bodies: Bodies): void {
    const joint = object.joint as NonNullable<ObjectView["joint"]>;
    const carrier = bodies.movers[joint.base_mover ?? bodies.view.n_movers] as Group;
    const length = 0.34 * bodies.size;
    for (const axis of joint.axes) {
      const direction = new Vector3(...axis).normalize();
      const holder = new Group();
      holder.applyMatrix4(poseMatrix(joint.base_pose));
      const arrow = new Arrow(AXIS, 0.45 * bodies.size);
      arrow.set(direction.clone().multiplyScalar(-0.5 * length), direction, length);
      holder.add(arrow);
      this.hang(carrier, holder);
    }
  }

  private center(object: ObjectView, size: number): Object3D {
    const ball = new Mesh(new SphereGeometry(0.022 * size, 20, 14), new MeshBasicMaterial({ color: CENTER, depthTest: false, transparent: true }));
    ball.position.set(...(object.mass as NonNullable<ObjectView["mass"]>)[1]);
    ball.renderOrder = 5;
    return ball;
  }

  private box(object: ObjectView): Object3D {
    const [mass, center, inertia] = object.mass as NonNullable<ObjectView["mass"]>;
    const { size, rotation } = inertiaBox(mass, inertia);
    const edges = new LineSegments(new EdgesGeometry(new BoxGeometry(...size.toArray())), new LineBasicMaterial({ color: CENTER, depthTest: false, transparent: true }));
    edges.position.set(...center);
    edges.quaternion.copy(rotation);
    edges.renderOrder = 5;
    return edges;
  }

  private frame(node: Object3D, length: number): void {
    const axes = new AxesHelper(length);
    (axes.material as Material).depthTest = false;
    axes.renderOrder = 5;
    this.hang(node, axes);
  }

  /** A spiral about the axis of a turning joint, a coil along that of a sliding one. */
  private springs(object: ObjectView, node: Object3D, size: number): void {
    const joint = object.joint as NonNullable<ObjectView["joint"]>;
    for (const [dof] of joint.springs) {
      const axis = joint.axes[Math.min(dof, joint.axes.length - 1)];
      if (!axis) continue;
      const slides = object.kind.startsWith("prismatic");
      const points: Vector3[] = [];
      for (let k = 0; k <= 160; k++) {
        const [share, angle] = [k / 160, (k / 160) * 2 * Math.PI * 5];
        const radius = (slides ? 0.03 : 0.015 + 0.045 * share) * size;
        points.push(new Vector3(radius * Math.cos(angle), radius * Math.sin(angle), slides ? (share - 0.5) * 0.3 * size : 0.02 * size));
      }
      const coil = new Mesh(new TubeGeometry(new CatmullRomCurve3(points), 220, 0.004 * size, 6), new MeshBasicMaterial({ color: SPRING }));
      coil.quaternion.setFromUnitVectors(new Vector3(0, 0, 1), new Vector3(...axis).normalize());
      this.hang(node, coil);
    }
  }

  /** The line of a spring-damper or tendon, through its points. */
  private line(points: LinePoint[], bodies: Bodies): void {
    const radius = 0.006 * bodies.size;
    for (let k = 1; k < points.length; k++) {
      const piece = new Mesh(new CylinderGeometry(radius, radius, 1, 8), new MeshBasicMaterial({ color: SPRING }));
      piece.name = "line";
      this.pieces.push({ piece, ends: [points[k - 1] as LinePoint, points[k] as LinePoint] });
      this.hang(bodies.root, piece);
    }
  }

  /** Rings at both ends of a closure: in one another where it is closed. */
  private closure(object: ObjectView, bodies: Bodies): void {
    const ends: [number | null, ObjectView["pose"]][] = [[object.mover, object.pose], object.other_end as [number | null, ObjectView["pose"]]];
    ends.forEach(([mover, pose], k) => {
      const radius = (k === 0 ? 0.03 : 0.045) * bodies.size;
      const ring = new Mesh(new TorusGeometry(radius, 0.16 * radius, 10, 36), new MeshBasicMaterial({ color: CLOSURE, depthTest: false, transparent: true }));
      ring.applyMatrix4(poseMatrix(pose));
      ring.renderOrder = 5;
      this.hang(bodies.movers[mover ?? bodies.view.n_movers] as Group, ring);
    });
  }

  /** Where a proximity sensor sees. */
  private volume(node: Object3D, edges: NonNullable<ObjectView["volume"]>): void {
    const points = edges.flat().map((p) => new Vector3(...p));
    const material = new LineBasicMaterial({ color: VOLUME, transparent: true, opacity: 0.55 });
    const lines = new LineSegments(new BufferGeometry().setFromPoints(points), material);
    lines.name = "volume";
    this.hang(node, lines);
  }

  /** What a camera sees, as far as its edges reach. */
  private camera(node: Object3D, field_of_view_deg: number, size: number): void {
    const [far, tall] = [0.16 * size, 0.16 * size * Math.tan((field_of_view_deg * Math.PI) / 360)];
    const wide = 1.5 * tall;
    const corners = [[wide, tall], [-wide, tall], [-wide, -tall], [wide, -tall]].map(([x, y]) => new Vector3(x, y, far));
    const points = corners.flatMap((corner, k) => [new Vector3(), corner, corner, corners[(k + 1) % 4] as Vector3]);
    const edges = new LineSegments(new BufferGeometry().setFromPoints(points), new LineBasicMaterial({ color: PATH }));
    this.hang(node, edges);
  }

  /** Where an object goes in the whole run. */
  private path(object: number, bodies: Bodies): void {
    const { run, t } = this.session;
    const points: number[] = [];
    const every = Math.max(1, Math.floor(run.times.n / 2000));
    const at = new Vector3();
    for (let k = 0; k < run.times.n; k += every) {
      bodies.place(run, run.times.at(k, 0));
      bodies.root.updateMatrixWorld(true);
      bodies.position(object, at);
      points.push(at.x, at.y, at.z);
    }
    bodies.place(run, t);
    const shape = new BufferGeometry().setAttribute("position", new Float32BufferAttribute(points, 3));
    const line = new Line(shape, new LineBasicMaterial({ color: PATH }));
    this.made.push(line);
    this.scene.add(line);
  }
}
