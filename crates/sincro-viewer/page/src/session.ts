// What the page is looking at: the runs, the time, what is selected; and who must know when that changes.

import type { Film, ObjectView, Property, SceneView } from "./film";
import type { Link } from "./link";
import { Run } from "./run";

/** What may change. `frames`: a run has grown. */
export type Topic = "time" | "runs" | "frames" | "selection" | "playing" | "shown" | "plots" | "properties" | "live" | "notice" | "camera";

/** What is drawn over the bodies. */
export const SHOWN = {
  axes: { label: "joint axes", on: false },
  centers: { label: "centres of mass", on: false },
  inertia: { label: "inertia boxes", on: false },
  frames: { label: "frames", on: false },
  springs: { label: "springs and tendons", on: true },
  rotors: { label: "thrust", on: true },
  forces: { label: "external forces", on: true },
  contacts: { label: "contact points", on: true },
  contactForces: { label: "contact forces", on: true },
  drags: { label: "drag", on: true },
  wind: { label: "wind", on: true },
  closures: { label: "closures", on: true },
  volumes: { label: "volumes of sensors", on: true },
  trace: { label: "path", on: true },
  grid: { label: "ground", on: true },
  shadows: { label: "shadows", on: true },
} as const;

export type Shown = keyof typeof SHOWN;

/** Whether a scene has what a toggle shows. */
export function applies(view: SceneView, runs: Run[], key: Shown): boolean {
  const some = (has: (o: ObjectView) => boolean) => view.objects.some(has);
  switch (key) {
    case "axes": return some((o) => (o.joint?.axes.length ?? 0) > 0);
    case "centers":
    case "inertia": return some((o) => o.mass !== null);
    case "springs": return some((o) => (o.joint?.springs.length ?? 0) > 0 || o.line !== undefined);
    case "rotors": return view.n_rotors > 0;
    case "forces": return view.n_forces > 0;
    case "contacts":
    case "contactForces": return view.surfaces.length > 0;
    case "drags": return view.n_drags > 0;
    case "wind": return view.winds.length > 0;
    case "closures": return some((o) => o.other_end !== undefined);
    case "volumes": return some((o) => (o.volume?.length ?? 0) > 0) || runs.some((run) => run.runtime.some((event) => "put" in event && event.put.volume !== undefined));
    default: return true;
  }
}

export class Session {
  runs: Run[] = [];
  active = 0;
  t = 0;
  playing = false;
  speed = 1;
  selected: number | null = null;
  hovered: number | null = null;
  follow = false;
  properties: Property[];
  readonly shown: Record<Shown, boolean>;
  link: Link | null = null;
  notice = "";
  /** Plots a signal; the scopes set it. */
  plot: (signal: string) => void = () => undefined;
  private readonly listeners = new Map<Topic, (() => void)[]>();

  constructor(readonly film: Film) {
    this.runs = film.runs.map((reel, k) => Run.ofReel(film, reel, k));
    if (film.overlaid) this.runs.forEach((run) => (run.isVisible = true));
    this.properties = film.properties;
    this.shown = Object.fromEntries(Object.entries(SHOWN).map(([key, { on }]) => [key, on])) as Record<Shown, boolean>;
  }

  get run(): Run {
    return this.runs[this.active] as Run;
  }

  get view(): SceneView {
    return this.run.view;
  }

  /** Where the timeline ends [s]: the experiment's duration, or the longest run. */
  get end(): number {
    return Math.max(this.link ? this.film.duration : 0, ...this.runs.filter((r, k) => r.isVisible || k === this.active).map((r) => r.end));
  }

  on(topic: Topic, listener: () => void): void {
    const known = this.listeners.get(topic) ?? [];
    known.push(listener);
    this.listeners.set(topic, known);
  }

  tell(...topics: Topic[]): void {
    for (const topic of topics) for (const listener of this.listeners.get(topic) ?? []) listener();
  }

  seek(t: number): void {
    this.t = Math.min(Math.max(t, 0), Math.max(this.run.end, 0));
    this.tell("time");
  }

  /** By so many frames, onto a frame. */
  stepFrames(n: number): void {
    const run = this.run;
    const { k, share } = run.locate(this.t);
    const to = n < 0 && share > 1e-9 ? k + n + 1 : k + n;
    this.seek(run.times.at(Math.min(Math.max(to, 0), run.times.n - 1), 0));
  }

  select(object: number | null): void {
    this.selected = object;
    this.tell("selection");
  }

  activate(k: number): void {
    this.active = k;
    this.run.isVisible = true;
    this.tell("runs", "frames", "time");
  }

  say(words: string): void {
    this.notice = words;
    this.tell("notice");
  }

  /** Plays on by `dt` seconds of the wall clock; only what is recorded. */
  tick(dt: number): void {
    if (!this.playing || this.link?.isRunning) return;
    const end = this.run.end;
    const t = this.t + dt * this.speed;
    if (t >= end) {
      this.playing = false;
      this.t = end;
      this.tell("time", "playing");
    } else {
      this.t = t;
      this.tell("time");
    }
  }

  /** The play button: what is recorded is shown again; at its end a live run goes on. */
  togglePlay(): void {
    if (this.link) {
      this.link.togglePlay();
      return;
    }
    if (!this.playing && this.t >= this.run.end - 1e-9) this.t = 0;
    this.playing = !this.playing;
    this.tell("playing", "time");
  }
}
