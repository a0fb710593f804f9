// One run: its frames, its recorded signals, and how to look up either at a time.

import { doubles, singles, type Film, type Reel, type RuntimeEvent, type SceneView } from "./film";
import { countUpTo, Rows } from "./growing";

export interface Column {
  name: string;
  unit: string;
  errorBar: number | null;
}

export interface Reference {
  times: Float64Array;
  values: Float64Array;
}

/** Numbers of a point of contact. */
export const CONTACT = 8;

export type Three = [number, number, number];

export class Run {
  readonly times = Rows.doubles(1);
  readonly frames: Rows<Float32Array>;
  /** How many points of contact there are up to and with each frame. */
  private readonly contactEnds = Rows.doubles(1);
  /** Points of contact: two surfaces, point [m], force on the first one [N], world axes. */
  readonly contacts = Rows.singles(CONTACT);
  readonly rowTimes: Rows<Float64Array>;
  readonly rows: Rows<Float64Array>;
  readonly references = new Map<string, Reference>();
  /** Changes of objects that were made at run time, in the order of time. */
  readonly runtime: RuntimeEvent[] = [];
  every = 1;
  /** Some of those changes are left out. */
  isCut = false;
  stop = "";
  trace = "";
  isVisible: boolean;
  /** Where the parts of a frame begin. */
  private readonly forcesAt: number;
  private readonly dragsAt: number;
  private readonly windsAt: number;
  private readonly qAt: number;

  constructor(
    readonly id: number,
    readonly name: string,
    readonly about: string,
    readonly view: SceneView,
    readonly columns: Column[],
  ) {
    this.forcesAt = 7 * view.n_movers + 3 * view.n_rotors;
    this.dragsAt = this.forcesAt + 3 * view.n_forces;
    this.windsAt = this.dragsAt + 3 * view.n_drags;
    this.qAt = this.windsAt + 3 * view.winds.length;
    this.frames = Rows.singles(this.qAt + view.n_q + view.n_v);
    this.rowTimes = Rows.doubles(1);
    this.rows = Rows.doubles(columns.length);
    this.isVisible = id === 0;
  }

  static ofReel(film: Film, reel: Reel, id: number): Run {
    const columns = reel.signals.columns.map(([name, unit, errorBar]) => ({ name, unit, errorBar }));
    const run = new Run(id, reel.name, reel.about, film.views[reel.view] as SceneView, columns);
    run.times.push(doubles(reel.frames.times));
    run.frames.push(singles(reel.frames.numbers));
    run.addContacts(singles(reel.frames.counts), singles(reel.frames.contacts));
    const times = doubles(reel.signals.times);
    const numbers = doubles(reel.signals.numbers);
    const rows = new Float64Array(numbers.length);
    for (let c = 0; c < columns.length; c++) {
      for (let k = 0; k < times.length; k++) rows[k * columns.length + c] = numbers[c * times.length + k] as number;
    }
    run.rowTimes.push(times);
    run.rows.push(rows);
    for (const [signal, t, values] of reel.signals.references) {
      run.references.set(signal, { times: doubles(t), values: doubles(values) });
    }
    // one by one: a call has room for some ten thousand arguments
    for (const event of reel.runtime ?? []) run.runtime.push(event);
    run.isCut = reel.runtime_is_cut ?? false;
    run.every = reel.signals.every;
    run.stop = reel.stop;
    run.trace = reel.trace;
    return run;
  }

  get end(): number {
    return this.times.n > 0 ? this.times.at(this.times.n - 1, 0) : 0;
  }

  get start(): number {
    return this.times.n > 0 ? this.times.at(0, 0) : 0;
  }

  /** The frame at or before `t`, and the share of the way to the next one. */
  locate(t: number): { k: number; share: number } {
    const n = this.times.n;
    if (n === 0) return { k: 0, share: 0 };
    const k = Math.max(0, countUpTo(this.times.view(), n, t + 1e-12) - 1);
    if (k + 1 >= n) return { k, share: 0 };
    const from = this.times.at(k, 0);
    const share = (t - from) / (this.times.at(k + 1, 0) - from);
    return { k, share: Math.min(1, Math.max(0, share)) };
  }

  /** Points of contact of the next frames: how many there are in each, then all of them. */
  addContacts(counts: ArrayLike<number>, points: Float32Array): void {
    const ends = new Float64Array(counts.length);
    let end = this.contacts.n;
    for (let k = 0; k < counts.length; k++) ends[k] = end += counts[k] as number;
    this.contactEnds.push(ends);
    this.contacts.push(points);
  }

  /** Rows of `contacts` that belong to the frame at or before `t`. */
  contactsAt(t: number): { from: number; to: number } {
    const { k } = this.locate(t);
    if (k >= this.contactEnds.n) return { from: 0, to: 0 };
    return { from: k === 0 ? 0 : this.contactEnds.at(k - 1, 0), to: this.contactEnds.at(k, 0) };
  }

  /** A number of the frame at `t`, on the straight line between frames. */
  number(t: number, column: number): number {
    const { k, share } = this.locate(t);
    if (this.times.n === 0) return NaN;
    const a = this.frames.at(k, column);
    return share > 0 ? a + share * (this.frames.at(k + 1, column) - a) : a;
  }

  q(t: number, index: number): number {
    return this.number(t, this.qAt + index);
  }

  v(t: number, index: number): number {
    return this.q(t, this.view.n_q + index);
  }

  /** Components of an external force in the world [N]. */
  force(t: number, index: number): Three {
    return this.three(t, this.forcesAt + 3 * index);
  }

  /** Components of the force of a drag element in the world [N]. */
  drag(t: number, index: number): Three {
    return this.three(t, this.dragsAt + 3 * index);
  }

  /** Wind [m/s] at mover `winds[index]`, world axes. */
  wind(t: number, index: number): Three {
    return this.three(t, this.windsAt + 3 * index);
  }

  private three(t: number, at: number): Three {
    return [this.number(t, at), this.number(t, at + 1), this.number(t, at + 2)];
  }

  /** Speed, thrust or torque (0, 1, 2) of a rotor. */
  rotor(t: number, index: number, what: 0 | 1 | 2): number {
    return this.number(t, 7 * this.view.n_movers + 3 * index + what);
  }

  /** The last recorded value of a signal at or before `t`. */
  value(t: number, name: string): number | null {
    const c = this.columns.findIndex((column) => column.name === name);
    const k = countUpTo(this.rowTimes.view(), this.rowTimes.n, t + 1e-12) - 1;
    return c < 0 || k < 0 ? null : this.rows.at(k, c);
  }
}
