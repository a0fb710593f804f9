// The reader's hand: with Ctrl held, a drag pulls the body under the mouse like a spring, while a live run goes on.

import { BufferGeometry, Float32BufferAttribute, Line, LineBasicMaterial, Plane, Raycaster, Vector2, Vector3, type Camera, type Object3D, type Scene } from "three";
import { el, format } from "../format";
import type { Session } from "../session";

/** Milliseconds between two messages. */
const PAUSE = 40;

interface Grip {
  object: number;
  node: Object3D;
  /** Where it was seized, in the frame of the node [m]. */
  local: Vector3;
  at: Vector2;
}

export class Push {
  readonly label = el("div", { class: "sv-push", hidden: true });
  private grip: Grip | null = null;
  private sent = 0;
  private readonly line = new Line(new BufferGeometry(), new LineBasicMaterial({ color: "#d55e00", depthTest: false }));

  constructor(private readonly session: Session, private readonly camera: Camera, scene: Scene) {
    this.line.visible = false;
    this.line.renderOrder = 9;
    this.line.frustumCulled = false;
    scene.add(this.line);
  }

  get isHeld(): boolean {
    return this.grip !== null;
  }

  seize(object: number, node: Object3D, point: Vector3, at: Vector2): void {
    this.grip = { object, node, local: node.worldToLocal(point.clone()), at };
  }

  move(at: Vector2): void {
    if (this.grip) this.grip.at = at;
    this.pull();
  }

  letGo(): void {
    if (!this.grip) return;
    this.grip = null;
    this.line.visible = false;
    this.label.hidden = true;
    this.session.link?.send({ do: "release" });
  }

  /** Sends the force, and draws it. */
  pull(): void {
    const { grip, session } = this;
    if (!grip || !session.link?.isRunning) return;
    const from = grip.node.localToWorld(grip.local.clone());
    const ray = new Raycaster();
    ray.setFromCamera(grip.at, this.camera);
    const plane = new Plane().setFromNormalAndCoplanarPoint(this.camera.getWorldDirection(new Vector3()), from);
    const to = ray.ray.intersectPlane(plane, new Vector3());
    if (!to) return;
    // a pull over a metre is as strong as ten times the weight of what is seized, or as ten newtons
    const mass = session.view.objects[grip.object]?.mass?.[0] ?? 0;
    const force = to.clone().sub(from).multiplyScalar(Math.max(10, 98.1 * mass));
    this.line.geometry.dispose();
    this.line.geometry = new BufferGeometry().setAttribute("position", new Float32BufferAttribute([...from.toArray(), ...to.toArray()], 3));
    this.line.visible = true;
    this.label.hidden = false;
    this.label.textContent = `${format(force.length(), 3)} N`;
    const now = performance.now();
    if (now - this.sent < PAUSE) return;
    this.sent = now;
    session.link.send({ do: "push", object: grip.object, point: from.toArray(), force: force.toArray() });
  }
}
