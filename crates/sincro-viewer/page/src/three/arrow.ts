// Arrows of forces and wind: solid, visible through bodies, in one piece from a point along a vector.

import { ConeGeometry, CylinderGeometry, Group, Mesh, MeshBasicMaterial, Quaternion, Vector3 } from "three";

const Z = new Vector3(0, 0, 1);

export class Arrow extends Group {
  private readonly shaft: Mesh;
  private readonly head: Mesh;

  /** `size`: that of the mechanism [m], which decides how thick it is. */
  constructor(color: string, private readonly size: number) {
    super();
    const material = new MeshBasicMaterial({ color, depthTest: false, transparent: true, opacity: 0.9 });
    this.shaft = new Mesh(new CylinderGeometry(1, 1, 1, 14).rotateX(Math.PI / 2).translate(0, 0, 0.5), material);
    this.head = new Mesh(new ConeGeometry(1, 1, 18).rotateX(Math.PI / 2).translate(0, 0, -0.5), material);
    this.renderOrder = 6;
    for (const part of [this.shaft, this.head]) part.renderOrder = 6;
    this.add(this.shaft, this.head);
    this.visible = false;
  }

  /** From a point along a direction of length one; hidden if it is too short to be seen. */
  set(from: Vector3, direction: Vector3, length: number): void {
    this.visible = Number.isFinite(length) && length > 2e-3 * this.size;
    if (!this.visible) return;
    const head = Math.min(0.075 * this.size, 0.45 * length);
    this.position.copy(from);
    this.quaternion.copy(new Quaternion().setFromUnitVectors(Z, direction));
    const thick = 0.17 * head;
    this.shaft.scale.set(thick, thick, Math.max(length - 0.9 * head, 1e-9));
    this.head.position.set(0, 0, length);
    this.head.scale.set(0.42 * head, 0.42 * head, head);
  }
}
