// What is drawn over the bodies on wish: axes, centres of mass, boxes of inertia, frames, springs, thrust, forces, paths.

import {
  ArrowHelper, AxesHelper, BoxGeometry, BufferGeometry, CatmullRomCurve3, EdgesGeometry, Float32BufferAttribute, Group, Line, LineBasicMaterial,
  LineSegments, Mesh, MeshBasicMaterial, Object3D, SphereGeometry, TubeGeometry, Vector3, type Material, type Scene,
} from "three";
import type { ObjectView } from "../film";
import type { Session } from "../session";
import type { Bodies } from "./bodies";
import { inertiaBox, poseMatrix } from "./shapes";

const AXIS = "#d55e00";
const CENTER = "#cc79a7";
const SPRING = "#b58900";
const THRUST = "#009e73";
const FORCE = "#d55e00";
const PATH = "#0072b2";

export class Overlays {
  private readonly made: Object3D[] = [];
  private arrows: { rotor: number; arrow: ArrowHelper }[] = [];
  private forces: { force: number; node: Object3D; arrow: ArrowHelper; most: number }[] = [];
  private bodies: Bodies | null = null;

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
    this.arrows = [];
    this.forces = [];
    this.bodies = bodies;
    const { shown, view } = this.session;
    view.objects.forEach((object, k) => {
      const node = bodies.nodes[k] as Object3D;
      if (shown.axes && object.joint) this.jointAxes(object, bodies);
      if (object.mass && shown.centers) this.hang(node, this.center(object, bodies.size));
      if (object.mass && shown.inertia) this.hang(node, this.box(object));
      if (shown.frames && object.kind !== "force") this.frame(node, 0.12 * bodies.size);
      if (shown.springs && object.joint) this.springs(object, node, bodies.size);
      if (shown.rotors && object.rotor) this.thrust(object.rotor.index, node, bodies.size);
      if (shown.forces && object.force !== null) this.force(object.force, node, bodies.size);
    });
    if (shown.trace && this.session.selected !== null) this.path(this.session.selected, bodies);
  }

  /** Lengths of arrows at `t`. */
  place(t: number): void {
    const { run, view } = this.session;
    if (!this.bodies || run.times.n === 0) return;
    this.placeForces(t, this.bodies.size);
    const weight = view.objects.reduce((sum, o) => sum + (o.mass?.[0] ?? 0), 0) * Math.hypot(...view.gravity);
    for (const { rotor, arrow } of this.arrows) {
      const thrust = run.rotor(t, rotor, 1);
      // as long as the mechanism where one rotor carries all the weight
      const length = (this.bodies.size * 2 * thrust) / Math.max(weight, 1e-9);
      arrow.visible = Number.isFinite(length) && Math.abs(length) > 1e-4 * this.bodies.size;
      if (!arrow.visible) continue;
      arrow.setDirection(new Vector3(0, 0, Math.sign(length)));
      arrow.setLength(Math.abs(length), 0.22 * Math.min(Math.abs(length), this.bodies.size), 0.1 * Math.min(Math.abs(length), this.bodies.size));
    }
  }

  private placeForces(t: number, size: number): void {
    for (const known of this.forces) {
      const components = new Vector3(...this.session.run.force(t, known.force));
      known.most = Math.max(known.most, components.length());
      const length = known.most > 0 ? (size * components.length()) / known.most : 0;
      known.arrow.visible = length > 1e-3 * size;
      if (!known.arrow.visible) continue;
      known.arrow.position.copy(known.node.getWorldPosition(new Vector3()));
      known.arrow.setDirection(components.normalize());
      known.arrow.setLength(length, 0.2 * length, 0.09 * length);
    }
  }

  /** An arrow in the world, as long as the mechanism where the force is greatest in the run. */
  private force(force: number, node: Object3D, size: number): void {
    const { run } = this.session;
    let most = 0;
    for (let k = 0; k < run.times.n; k++) most = Math.max(most, Math.hypot(...run.force(run.times.at(k, 0), force)));
    const arrow = new ArrowHelper(new Vector3(0, 0, 1), new Vector3(), size, FORCE);
    this.made.push(arrow);
    this.scene.add(arrow);
    this.forces.push({ force, node, arrow, most });
  }

  private hang(node: Object3D, what: Object3D): void {
    node.add(what);
    this.made.push(what);
  }

  private jointAxes(object: ObjectView, bodies: Bodies): void {
    const joint = object.joint as NonNullable<ObjectView["joint"]>;
    const carrier = bodies.movers[joint.base_mover ?? bodies.view.n_movers] as Group;
    const length = 0.3 * bodies.size;
    for (const axis of joint.axes) {
      const direction = new Vector3(...axis).normalize();
      const holder = new Group();
      holder.applyMatrix4(poseMatrix(joint.base_pose));
      const from = direction.clone().multiplyScalar(-0.5 * length);
      holder.add(new ArrowHelper(direction, from, length, AXIS, 0.2 * length, 0.09 * length));
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

  private thrust(rotor: number, node: Object3D, size: number): void {
    const arrow = new ArrowHelper(new Vector3(0, 0, 1), new Vector3(), size, THRUST);
    this.hang(node, arrow);
    this.arrows.push({ rotor, arrow });
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
