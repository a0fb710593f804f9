// Solids as meshes: the shapes of a scene, boxes of equal inertia, rotor discs.

import {
  BoxGeometry, BufferGeometry, CapsuleGeometry, ConeGeometry, CylinderGeometry, Float32BufferAttribute, PlaneGeometry, SphereGeometry, Matrix4, Quaternion, Vector3,
} from "three";
import type { Pose, ShapeView } from "../film";

const QUARTER = Math.PI / 2;
/** Triangles from which on a mesh is drawn round. */
const MANY = 1500;

/** The geometry of a shape, its axis of symmetry along z. */
export function geometry(shape: ShapeView): BufferGeometry {
  const [a, b, c] = shape.size as [number, number, number];
  switch (shape.kind) {
    case "cuboid":
      return new BoxGeometry(a, b, c);
    case "sphere":
      return new SphereGeometry(a, 32, 20);
    case "cylinder":
      return new CylinderGeometry(a, a, b, 36).rotateX(QUARTER);
    case "capsule":
      return new CapsuleGeometry(a, b, 10, 28).rotateX(QUARTER);
    case "cone":
      // centred on its centre of mass: the base at −length/4
      return new ConeGeometry(a, b, 36).rotateX(QUARTER).translate(0, 0, b / 4);
    case "plane":
      // one metre of it: the picture scales the piece that it shows
      return new PlaneGeometry(1, 1);
    case "mesh":
      return triangles(shape.vertices ?? [], shape.triangles ?? []);
  }
}

/** Triangles with flat faces, or, where there are many, with round ones. */
function triangles(vertices: number[][], faces: number[][]): BufferGeometry {
  const shape = new BufferGeometry().setAttribute("position", new Float32BufferAttribute(vertices.flat(), 3));
  shape.setIndex(faces.flat());
  const made = faces.length > MANY ? shape : shape.toNonIndexed();
  made.computeVertexNormals();
  return made;
}

export function poseMatrix(pose: Pose): Matrix4 {
  return new Matrix4().compose(
    new Vector3(pose[0], pose[1], pose[2]),
    new Quaternion(pose[3], pose[4], pose[5], pose[6]),
    new Vector3(1, 1, 1),
  );
}

/** How far a shape reaches from its own origin [m]. */
export function reach(shape: ShapeView): number {
  const [a, b, c] = shape.size as [number, number, number];
  switch (shape.kind) {
    case "cuboid":
      return Math.hypot(a, b, c) / 2;
    case "sphere":
      return a;
    case "cylinder":
      return Math.hypot(a, b / 2);
    case "capsule":
      return a + b / 2;
    case "cone":
      return Math.max(Math.hypot(a, b / 4), 0.75 * b);
    case "plane":
      return 0;
    case "mesh":
      return (shape.vertices ?? []).reduce((most, p) => Math.max(most, Math.hypot(...p)), 0);
  }
}

/** Edges [m] and axes of the homogeneous box with this mass and inertia (xx, xy, xz, yy, yz, zz). An edge that no real body could have is thin. */
export function inertiaBox(mass: number, inertia: readonly number[]): { size: Vector3; rotation: Quaternion } {
  const [xx, xy, xz, yy, yz, zz] = inertia as [number, number, number, number, number, number];
  const { values, axes } = eigen([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]);
  const total = values[0] + values[1] + values[2];
  const squares = values.map((moment) => (6 * (total - 2 * moment)) / mass);
  const longest = Math.sqrt(Math.max(...squares, 1e-12));
  const size = squares.map((square) => Math.max(Math.sqrt(Math.max(square, 0)), 0.04 * longest)) as [number, number, number];
  const basis = new Matrix4().makeBasis(...axes);
  if (basis.determinant() < 0) basis.makeBasis(axes[0], axes[1], axes[2].negate());
  return { size: new Vector3(...size), rotation: new Quaternion().setFromRotationMatrix(basis) };
}

type Three<T> = [T, T, T];

/** Eigenvalues and eigenvectors of a symmetric matrix by Jacobi rotations. */
function eigen(m: Three<Three<number>>): { values: Three<number>; axes: Three<Vector3> } {
  const a = m.map((row) => [...row]) as Three<Three<number>>;
  const v: Three<Three<number>> = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  for (let sweep = 0; sweep < 12; sweep++) {
    for (const [p, q] of [[0, 1], [0, 2], [1, 2]] as [0 | 1, 1 | 2][]) {
      if (Math.abs(a[p][q]) < 1e-300) continue;
      const theta = (a[q][q] - a[p][p]) / (2 * a[p][q]);
      const t = (theta < 0 ? -1 : 1) / (Math.abs(theta) + Math.sqrt(theta * theta + 1));
      const c = 1 / Math.sqrt(t * t + 1);
      const s = t * c;
      for (let k = 0 as 0 | 1 | 2; k < 3; k++) {
        const [x, y] = [a[k][p], a[k][q]];
        a[k][p] = c * x - s * y;
        a[k][q] = s * x + c * y;
      }
      for (let k = 0 as 0 | 1 | 2; k < 3; k++) {
        const [x, y] = [a[p][k], a[q][k]];
        a[p][k] = c * x - s * y;
        a[q][k] = s * x + c * y;
        const [vx, vy] = [v[k][p], v[k][q]];
        v[k][p] = c * vx - s * vy;
        v[k][q] = s * vx + c * vy;
      }
    }
  }
  const axis = (k: 0 | 1 | 2) => new Vector3(v[0][k], v[1][k], v[2][k]);
  return { values: [a[0][0], a[1][1], a[2][2]], axes: [axis(0), axis(1), axis(2)] };
}
