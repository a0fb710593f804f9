// The picture: camera, light, ground, and what the reader does with the mouse.

import {
  AxesHelper, Box3, Color, DirectionalLight, GridHelper, HemisphereLight, MOUSE, Mesh, PCFShadowMap, PerspectiveCamera, PlaneGeometry, Quaternion, Raycaster,
  Scene, ShadowMaterial, Vector2, Vector3, WebGLRenderer, type Material, type Object3D,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { el, nice, save } from "../format";
import type { ObjectView } from "../film";
import type { Session } from "../session";
import { Bodies } from "./bodies";
import { Overlays } from "./overlays";
import { Push } from "./push";
import { RuntimeObjects, corners } from "./runtime";
import { Vectors } from "./vectors";

/** The page's own cameras: where they stand, seen from what they look at. */
export const CAMERAS: [string, [number, number, number]][] = [
  ["perspective", [0.55, -1, 0.42]],
  ["front (along y)", [0, -1, 0.001]],
  ["side (along x)", [1, 0, 0.001]],
  ["top (along z)", [0, -0.001, 1]],
];

/** Field of view of the page's own cameras [deg]. */
const FIELD = 38;
const HALF_TURN = new Quaternion(0, 1, 0, 0);

/** Names of all cameras: the page's own, then the scene's. */
export function cameraNames(session: Session): string[] {
  return [...CAMERAS.map(([name]) => name), ...session.view.objects.filter((o) => o.camera).map((o) => o.path)];
}

export class Stage {
  readonly node = el("div", { class: "sv-stage", tabindex: "0", "aria-label": "3-D view of the scene", role: "img" });
  private readonly renderer: WebGLRenderer | null;
  private readonly scene = new Scene();
  private readonly camera = new PerspectiveCamera(FIELD, 1, 0.01, 1000);
  private readonly controls: OrbitControls;
  private readonly sun = new DirectionalLight("#ffffff", 2.1);
  private readonly axes = new AxesHelper(1);
  private ground: Object3D[] = [];
  private bodies = new Map<number, Bodies>();
  /** Objects that clients and scripts have made in the run that is looked at. */
  private runtime: RuntimeObjects | null = null;
  private readonly overlays: Overlays;
  private readonly vectors: Vectors;
  /** The scene's camera through which one looks. */
  private riding: number | null = null;
  private readonly push: Push;
  private readonly legend = el("div", { class: "sv-legend" });
  private gridWords = "";
  /** Size of what the ground was laid for [m]. */
  private laidFor = 0;
  /** There are planes, and none of them is level. */
  private isSloped = false;
  private isStale = true;
  /** The reader has turned the camera. */
  private wasMoved = false;
  private named = "perspective";
  private followed = new Vector3();
  /** Size of all that happens [m], and its middle. */
  private bounds = new Box3(new Vector3(-1, -1, 0), new Vector3(1, 1, 1));

  constructor(private readonly session: Session) {
    this.camera.up.set(0, 0, 1);
    this.renderer = makeRenderer();
    const canvas = this.renderer?.domElement ?? el("canvas");
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    // the middle button as in Blender: it turns, and shifts with Shift held
    this.controls.mouseButtons.MIDDLE = MOUSE.ROTATE;
    this.controls.addEventListener("change", () => (this.isStale = true));
    this.controls.addEventListener("start", () => this.alight());
    this.overlays = new Overlays(session, this.scene);
    this.vectors = new Vectors(session, this.scene);
    this.push = new Push(session, this.camera, this.scene);
    if (this.renderer) this.node.append(this.renderer.domElement, this.legend, this.push.label);
    else this.node.append(el("p", { class: "sv-nogl", text: "This browser shows no WebGL: the 3-D view is missing, everything else works." }));
    this.light();
    this.listen();
    this.rebuild();
    this.followFar();
    this.frame(this.first());
  }

  /** The camera that the address names, the scene's first one, or the page's own. */
  private first(): string {
    const asked = new URLSearchParams(location.hash.slice(1)).get("camera");
    const names = cameraNames(this.session);
    return names.find((name) => name === asked || name === `/${asked}`) ?? names[CAMERAS.length] ?? "perspective";
  }

  /** Name of the camera through which one looks, or looked before moving. */
  get cameraName(): string {
    return this.named;
  }

  /** What is small against its own way is followed from the start. */
  private followFar(): void {
    const flight = this.bounds.getSize(new Vector3()).length();
    const { objects } = this.session.view;
    const flies = objects.some((o) => o.kind === "free joint");
    const isFree = (o: ObjectView) => o.parent !== null && objects[o.parent]?.kind === "free joint";
    const free = objects.findIndex((o) => o.kind === "body" && isFree(o));
    const body = free >= 0 ? free : objects.findIndex((o) => o.kind === "body" && o.mover !== null);
    if (body < 0 || (flight < 5 * this.main.span && !(this.session.link && flies))) return;
    this.session.follow = true;
    this.session.select(body);
    this.session.tell("shown");
  }

  /** Draws if anything has changed. */
  draw(): void {
    const { clientWidth: w, clientHeight: h } = this.node;
    if (!this.renderer || w === 0 || h === 0) return;
    const size = this.renderer.getSize(new Vector2());
    if (size.x !== w || size.y !== h) {
      this.renderer.setSize(w, h, false);
      this.camera.aspect = w / h;
      this.camera.updateProjectionMatrix();
      if (size.x !== w && !this.wasMoved) this.frame(this.named);
      this.isStale = true;
    }
    if (!this.isStale) return;
    this.isStale = false;
    this.renderer.render(this.scene, this.camera);
    this.node.dataset["drawn"] = String(Number(this.node.dataset["drawn"] ?? "0") + 1);
  }

  /** The picture as it is now, as a file. */
  savePicture(): void {
    this.isStale = true;
    this.draw();
    this.renderer?.domElement.toBlob((blob) => blob && save(`${this.session.film.scene}-${this.session.t.toFixed(3)}s.png`, blob));
  }

  /** Takes a camera: one of the page's sees everything, one of the scene's stands where the scene says. */
  frame(name: string): void {
    this.named = name;
    this.wasMoved = false;
    const own = this.session.view.objects.findIndex((o) => o.camera && o.path === name);
    this.riding = own < 0 ? null : own;
    this.camera.fov = this.session.view.objects[own]?.camera?.field_of_view_deg ?? FIELD;
    this.session.tell("camera");
    this.overlays.through = this.riding;
    this.overlays.rebuild(this.main);
    if (this.riding !== null) {
      this.ride();
      return;
    }
    const [, direction] = CAMERAS.find(([known]) => known === name) ?? (CAMERAS[0] as (typeof CAMERAS)[number]);
    const center = this.bounds.getCenter(new Vector3());
    let box = this.bounds;
    if (this.session.follow && this.session.selected !== null) {
      center.copy(this.main.position(this.session.selected));
      box = new Box3().setFromCenterAndSize(center, new Vector3(1, 1, 1).multiplyScalar(1.35 * this.main.span));
    }
    this.look(center, direction, box);
  }

  /** As near as the whole box stays in the picture. */
  private look(center: Vector3, direction: [number, number, number], box: Box3): void {
    const back = new Vector3(...direction).normalize();
    const right = new Vector3(0, 0, 1).cross(back).normalize();
    const up = back.clone().cross(right);
    const tall = Math.tan((this.camera.fov * Math.PI) / 360);
    const wide = tall * (this.camera.aspect || 1);
    let distance = 1e-3;
    for (let k = 0; k < 8; k++) {
      const corner = new Vector3(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y, k & 4 ? box.max.z : box.min.z).sub(center);
      const depth = corner.dot(back);
      distance = Math.max(distance, Math.abs(corner.dot(right)) / wide + depth, Math.abs(corner.dot(up)) / tall + depth);
    }
    distance *= 1.12;
    this.camera.position.copy(center).addScaledVector(back, distance);
    this.camera.near = distance / 500;
    this.camera.far = distance * 60;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(center);
    this.controls.update();
    this.followed.copy(center);
    this.isStale = true;
  }

  /** While a live run goes on, the page's own cameras step back as far as what moves needs, until the reader takes them. */
  private keepInView(): void {
    if (!this.session.link?.isRunning || this.wasMoved || this.riding !== null || this.session.follow) return;
    const before = this.bounds.getSize(new Vector3()).length();
    const at = new Vector3();
    this.session.view.objects.forEach((object, k) => {
      if (!object.camera && object.mover !== null) this.bounds.expandByPoint(this.main.position(k, at));
    });
    const now = this.bounds.getSize(at).length();
    if (now > 1.001 * before) this.frame(this.named);
    if (now > 1.2 * this.laidFor) this.lay();
  }

  /** Puts the picture's camera where the scene's is. */
  private ride(): void {
    if (this.riding === null) return;
    const node = this.main.nodes[this.riding] as Object3D;
    node.updateWorldMatrix(true, false);
    node.getWorldPosition(this.camera.position);
    // the scene's cameras look along z, the picture's against it
    node.getWorldQuaternion(this.camera.quaternion).multiply(HALF_TURN);
    this.camera.near = 0.01 * this.main.size;
    this.camera.far = 400 * Math.max(this.main.size, this.bounds.getSize(new Vector3()).length());
    this.camera.updateProjectionMatrix();
    this.isStale = true;
  }

  /** The reader takes the camera: it goes on from where it is, upright. */
  private alight(): void {
    this.wasMoved = true;
    if (this.riding === null) return;
    const away = this.camera.position.distanceTo(this.bounds.getCenter(new Vector3()));
    const ahead = this.camera.getWorldDirection(new Vector3());
    this.controls.target.copy(this.camera.position).addScaledVector(ahead, Math.max(away, 0.2 * this.main.size));
    this.riding = null;
    this.overlays.through = null;
    this.followed.copy(this.session.selected === null ? this.controls.target : this.main.position(this.session.selected));
    this.controls.update();
  }

  private get main(): Bodies {
    return this.bodies.get(this.session.run.id) as Bodies;
  }

  /** Makes bodies for the runs that are shown, and drops the others. */
  private rebuild(): void {
    const { session } = this;
    this.runtime?.clear();
    for (const bodies of this.bodies.values()) bodies.dispose();
    this.bodies = new Map();
    session.runs.forEach((run, k) => {
      if (k !== session.active && !run.isVisible) return;
      const bodies = new Bodies(run.view, k !== session.active);
      this.bodies.set(run.id, bodies);
      this.scene.add(bodies.root);
    });
    this.measure();
    this.runtime = new RuntimeObjects(session.run, this.main);
    this.lay();
    this.overlays.rebuild(this.main);
    this.vectors.rebuild(this.main);
    this.main.highlight(session.selected, session.hovered);
    this.place();
  }

  /** Bounds of the whole run: positions of all objects over up to 60 frames. */
  private measure(): void {
    const { run } = this.session;
    const [bounds, at] = [new Box3(), new Vector3()];
    const frames = Math.max(1, Math.min(60, run.times.n));
    for (let k = 0; k < frames; k++) {
      const t = run.start + ((run.end - run.start) * k) / Math.max(1, frames - 1);
      this.main.place(run, t);
      this.main.root.updateMatrixWorld(true);
      run.view.objects.forEach((object, o) => {
        if (!object.camera && object.kind !== "coupling") bounds.expandByPoint(this.main.position(o, at));
      });
      if (k !== 0 && k !== frames - 1) continue;
      const solids = this.solids();
      bounds.union(solids);
      if (k > 0) continue;
      // what moves decides how large arrows are: a landscape does not
      const moving = new Box3();
      this.main.movers.slice(0, run.view.n_movers).forEach((mover) => moving.expandByObject(mover));
      const size = (moving.isEmpty() ? solids : moving).getSize(new Vector3()).length();
      if (size > 0) this.main.span = Math.max(0.6 * size, 1e-6);
    }
    corners(run).forEach((corner) => bounds.expandByPoint(corner));
    if (bounds.isEmpty()) bounds.set(new Vector3(-1, -1, 0), new Vector3(1, 1, 1));
    const least = 0.25 * this.main.span;
    const size = bounds.getSize(new Vector3());
    bounds.expandByVector(new Vector3(Math.max(0, least - size.x / 2), Math.max(0, least - size.y / 2), 0));
    this.bounds = bounds;
  }

  /** What all bodies take up now, planes left out. */
  private solids(): Box3 {
    const { planes } = this.main;
    planes.forEach((plane) => plane.removeFromParent());
    const box = new Box3().setFromObject(this.main.root);
    planes.forEach((plane) => (plane.userData["node"] as Object3D).add(plane));
    return box;
  }

  /** Ground below everything, its squares of a round size. */
  private lay(): void {
    this.laidFor = this.bounds.getSize(new Vector3()).length();
    for (const old of this.ground) old.removeFromParent();
    const { shown } = this.session;
    const isDark = matchMedia("(prefers-color-scheme: dark)").matches;
    const size = this.bounds.getSize(new Vector3());
    const span = Math.max(size.x, size.y, 0.6 * size.z, this.main.span);
    const cell = nice(span / 7);
    // a little below zero it touches what is lowest; far below it stands at a round height
    const { z: lowest } = this.bounds.min;
    const n = 2 * Math.ceil((1.6 * span) / cell);
    const levels = this.lieBelow(n, cell, isDark);
    const usual = lowest < -0.12 * this.main.size ? Math.floor(lowest / cell) * cell : Math.min(0, lowest);
    const low = levels.length > 0 ? Math.max(...levels) : usual;
    const center = this.bounds.getCenter(new Vector3());
    const [x, y] = [Math.round(center.x / cell) * cell, Math.round(center.y / cell) * cell];
    const grid = new GridHelper(n * cell, n, isDark ? "#59636e" : "#aab2bb", isDark ? "#353c44" : levels.length > 0 ? "#cdd3d9" : "#d5dae0");
    grid.rotation.x = Math.PI / 2;
    grid.position.set(x, y, low);
    const floor = new Mesh(new PlaneGeometry(n * cell, n * cell), new ShadowMaterial({ opacity: isDark ? 0.45 : 0.16 }));
    floor.position.set(x, y, low - 1e-4 * span);
    floor.receiveShadow = levels.length === 0;
    this.axes.scale.setScalar(1.4 * cell);
    (this.axes.material as Material).depthTest = true;
    this.ground = [grid, floor];
    for (const part of this.ground) part.visible = shown.grid && !this.isSloped;
    this.scene.add(grid, floor, this.axes);
    this.scene.background = new Color(isDark ? "#14181d" : "#f7f8fa");
    const at = low === 0 || this.isSloped ? "" : `, ground at z = ${String(+low.toPrecision(3)).replace("-", "−")} m`;
    this.gridWords = `grid ${+cell.toPrecision(3)} m${at}`;
    this.sun.position.copy(center).add(new Vector3(0.5, -0.7, 1.6).multiplyScalar(1.5 * span));
    this.sun.target.position.copy(center);
    const shadow = this.sun.shadow.camera;
    const half = 1.3 * Math.max(span, size.z);
    Object.assign(shadow, { left: -half, right: half, top: half, bottom: -half, near: 0.05 * span, far: 8 * Math.max(span, size.z) });
    shadow.updateProjectionMatrix();
    this.sun.shadow.normalBias = 0.004 * span;
  }

  /** Sizes the pieces of the scene's planes; heights of those that are level [m]. */
  private lieBelow(n: number, cell: number, isDark: boolean): number[] {
    const levels: number[] = [];
    const center = this.bounds.getCenter(new Vector3());
    this.isSloped = false;
    this.main.root.updateMatrixWorld(true);
    for (const plane of this.main.planes) {
      const node = plane.parent as Object3D;
      const normal = new Vector3(0, 0, 1).applyQuaternion(plane.quaternion);
      const rest = node.worldToLocal(center.clone()).sub(plane.position);
      plane.position.add(rest.addScaledVector(normal, -rest.dot(normal)));
      plane.scale.set(n * cell, n * cell, 1);
      for (const old of [...plane.children]) old.removeFromParent();
      const { z } = normal.transformDirection(node.matrixWorld);
      if (z > 1 - 1e-9) {
        plane.updateMatrixWorld(true);
        levels.push(plane.getWorldPosition(new Vector3()).z);
        continue;
      }
      this.isSloped = true;
      const lines = isDark ? "#3b434c" : "#c9ced5";
      plane.add(new GridHelper(1, n, lines, lines).rotateX(Math.PI / 2));
    }
    if (levels.length > 0) this.isSloped = false;
    return levels;
  }

  private drawLegend(): void {
    const rows = this.vectors.legend.map(([color, words]) => el("div", {}, el("i", { style: `background: ${color}` }), words));
    this.legend.replaceChildren(...rows, el("div", { text: this.gridWords }));
  }

  private light(): void {
    this.scene.add(new HemisphereLight("#ffffff", "#8d939c", 1.5), this.sun, this.sun.target);
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(2048, 2048);
  }

  private place(): void {
    const { session } = this;
    for (const run of session.runs) this.bodies.get(run.id)?.place(run, session.t);
    this.runtime?.place(session.t, session.shown.volumes);
    this.node.dataset["runtime"] = String(this.runtime?.count ?? 0);
    this.overlays.place(this.main);
    this.scene.updateMatrixWorld(true);
    this.vectors.place(session.t);
    this.drawLegend();
    this.push.pull();
    this.keepInView();
    this.ride();
    if (this.riding === null && session.follow && session.selected !== null) {
      const now = this.main.position(session.selected);
      const move = now.clone().sub(this.followed);
      this.camera.position.add(move);
      this.controls.target.add(move);
      this.followed.copy(now);
      this.controls.update();
    }
    this.isStale = true;
  }

  private listen(): void {
    const { session } = this;
    session.on("time", () => this.place());
    session.on("frames", () => this.place());
    session.on("runs", () => this.rebuild());
    session.on("playing", () => {
      if (!session.link || session.link.isRunning || session.playing) return;
      // a live run stands still: the ground and paths are laid for what has been recorded by now
      this.measure();
      this.lay();
      this.overlays.rebuild(this.main);
      this.vectors.rebuild(this.main);
      this.place();
    });
    session.on("selection", () => {
      this.main.highlight(session.selected, session.hovered);
      this.overlays.rebuild(this.main);
      if (session.selected !== null) this.followed.copy(this.main.position(session.selected));
      this.place();
    });
    session.on("shown", () => {
      for (const part of this.ground) part.visible = session.shown.grid && !this.isSloped;
      this.axes.visible = session.shown.grid;
      this.sun.castShadow = session.shown.shadows;
      this.overlays.rebuild(this.main);
      this.vectors.rebuild(this.main);
      this.place();
    });
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.rebuild());
    if (this.renderer) this.pick(this.renderer.domElement);
  }

  /** A click without a drag selects; hovering tells. */
  private pick(canvas: HTMLCanvasElement): void {
    const ray = new Raycaster();
    const place = (event: MouseEvent): Vector2 => {
      const box = canvas.getBoundingClientRect();
      return new Vector2((2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height);
    };
    const find = (event: MouseEvent) => {
      ray.setFromCamera(place(event), this.camera);
      return ray.intersectObjects(this.main.targets, false)[0];
    };
    const hit = (event: MouseEvent): number | null => {
      const found = find(event);
      return found ? (found.object.userData["object"] as number) : null;
    };
    canvas.addEventListener("pointerdown", (event) => {
      const found = event.ctrlKey && this.session.link?.isRunning ? find(event) : undefined;
      if (!found) return;
      const object = found.object.userData["object"] as number;
      this.push.seize(object, this.main.nodes[object] as Object3D, found.point, place(event));
      this.controls.enabled = false;
      canvas.setPointerCapture(event.pointerId);
    }, { capture: true });
    canvas.addEventListener("pointermove", (event) => {
      if (!this.push.isHeld) return;
      this.push.move(place(event));
      this.isStale = true;
    });
    for (const end of ["pointerup", "pointercancel"] as const) {
      canvas.addEventListener(end, () => {
        this.push.letGo();
        this.controls.enabled = true;
        this.isStale = true;
      });
    }
    let down: [number, number] = [0, 0];
    canvas.addEventListener("pointerdown", (event) => (down = [event.clientX, event.clientY]));
    canvas.addEventListener("pointerup", (event) => {
      if (Math.hypot(event.clientX - down[0], event.clientY - down[1]) < 4) this.session.select(hit(event));
    });
    canvas.addEventListener("dblclick", (event) => {
      const found = find(event);
      if (!found || this.riding !== null) return;
      // what was struck twice is what the camera turns about from now on
      this.wasMoved = true;
      this.controls.target.copy(found.point);
      this.controls.update();
    });
    canvas.addEventListener("pointermove", (event) => {
      if (event.buttons !== 0) return;
      const object = hit(event);
      if (object === this.session.hovered) return;
      this.session.hovered = object;
      canvas.title = object === null ? "" : (this.session.view.objects[object]?.path ?? "");
      this.main.highlight(this.session.selected, object);
      this.isStale = true;
    });
  }
}

function makeRenderer(): WebGLRenderer | null {
  try {
    const renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    renderer.shadowMap.enabled = true;
    renderer.shadowMap.type = PCFShadowMap;
    return renderer;
  } catch {
    return null;
  }
}
