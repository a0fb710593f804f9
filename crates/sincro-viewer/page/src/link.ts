// The line to `sincro view`: commands out; the scene once, then runs, states and frames in.

import type { Film, Property, RuntimeEvent, SceneView } from "./film";
import { CONTACT, Run } from "./run";
import type { Session } from "./session";

/** Bytes before the numbers of a message of frames. */
const HEAD = 24;

interface RunMessage {
  type: "run";
  id: number;
  name: string;
  about: string;
  view: SceneView;
  columns: [string, string][];
  references: [string, number[], number[]][];
  properties: Property[];
}

interface StateMessage {
  type: "state";
  run: number;
  playing: boolean;
  speed: number | null;
  factor: number | null;
  stop: string;
  done: boolean;
  trace: string;
}

interface RuntimeMessage {
  type: "runtime";
  id: number;
  events: RuntimeEvent[];
}

interface WordsMessage {
  type: "refused" | "saved";
  message: string;
}

type Message = RunMessage | RuntimeMessage | StateMessage | WordsMessage;

export class Link {
  isRunning = false;
  isDone = false;
  isConnected = true;
  factor: number | null = null;
  speed: number | null = 1;
  /** What is set against the files, in the order of setting; not yet run. */
  edits: [string, string][] = [];
  private undone: [string, string][][] = [];
  private past: [string, string][][] = [];
  /** What the run that goes on was made with. */
  ran: [string, string][] = [];
  private session: Session | null = null;

  private constructor(private readonly socket: WebSocket) {}

  /** Connects, and waits for the scene. */
  static open(address: string): Promise<{ film: Film; link: Link }> {
    return new Promise((resolve, reject) => {
      const socket = new WebSocket(address);
      socket.binaryType = "arraybuffer";
      const link = new Link(socket);
      const waiting: MessageEvent[] = [];
      socket.onerror = () => reject(new Error("sincro does not answer; is `sincro view` still running?"));
      socket.onmessage = (event) => {
        const film = JSON.parse(event.data as string) as Film;
        socket.onmessage = (next) => (link.session ? link.take(next) : waiting.push(next));
        resolve({ film, link });
        link.waiting = waiting;
      };
    });
  }

  private waiting: MessageEvent[] = [];

  /** From now on messages go to a session. */
  attach(session: Session): void {
    this.session = session;
    this.socket.onclose = () => {
      this.isConnected = false;
      this.isRunning = false;
      session.say("The connection to sincro is closed. What was recorded can still be looked at; reload the page to connect again.");
      session.tell("live", "playing");
    };
    for (const event of this.waiting.splice(0)) this.take(event);
  }

  send(message: Record<string, unknown>): void {
    if (this.isConnected) this.socket.send(JSON.stringify(message));
  }

  togglePlay(): void {
    const session = this.session as Session;
    if (this.isRunning) this.send({ do: "pause" });
    else if (session.playing) {
      session.playing = false;
      session.tell("playing");
    } else if (this.hasEdits) this.branch(session.t);
    else if (session.t < session.run.end - 1e-9) {
      session.playing = true;
      session.tell("playing");
    } else if (!this.isDone) this.play();
    else {
      session.seek(0);
      session.playing = true;
      session.tell("playing");
    }
  }

  play(): void {
    this.send({ do: "play" });
  }

  setSpeed(speed: number | null): void {
    this.speed = speed;
    this.send({ do: "speed", speed });
  }

  /** A new run from `t` on with what is set now. */
  branch(t: number, joints: [number, number][] = []): void {
    this.send({ do: "branch", run: this.session?.run.id ?? 0, t, set: this.edits, joints, play: joints.length === 0 });
  }

  get hasEdits(): boolean {
    return JSON.stringify(this.edits) !== JSON.stringify(this.ran);
  }

  edit(path: string, value: string): void {
    this.past.push(this.edits);
    this.undone = [];
    this.edits = [...this.edits.filter(([known]) => known !== path), [path, value]];
    this.session?.tell("live");
  }

  undo(): void {
    const before = this.past.pop();
    if (!before) return;
    this.undone.push(this.edits);
    this.edits = before;
    this.session?.tell("live");
  }

  redo(): void {
    const after = this.undone.pop();
    if (!after) return;
    this.past.push(this.edits);
    this.edits = after;
    this.session?.tell("live");
  }

  get canUndo(): boolean {
    return this.past.length > 0;
  }

  get canRedo(): boolean {
    return this.undone.length > 0;
  }

  private take(event: MessageEvent): void {
    if (typeof event.data !== "string") this.frames(event.data as ArrayBuffer);
    else this.words(JSON.parse(event.data) as Message);
  }

  private words(message: Message): void {
    const session = this.session as Session;
    switch (message.type) {
      case "run": {
        const columns = message.columns.map(([name, unit]) => ({ name, unit, errorBar: null }));
        const run = new Run(message.id, message.name, message.about, message.view, columns);
        for (const [signal, times, values] of message.references) {
          run.references.set(signal, { times: Float64Array.from(times), values: Float64Array.from(values) });
        }
        session.runs = [...session.runs.filter((known) => known.id !== run.id), run];
        session.properties = message.properties;
        this.ran = this.edits;
        session.active = session.runs.indexOf(run);
        session.runs.forEach((known) => (known.isVisible = known === run || known.id === run.id - 1));
        session.t = run.start;
        this.fresh = true;
        break;
      }
      case "runtime":
        for (const event of message.events) session.runs.find((known) => known.id === message.id)?.runtime.push(event);
        session.tell("frames");
        break;
      case "state": {
        const wasRunning = this.isRunning;
        this.isRunning = message.playing;
        this.isDone = message.done;
        this.factor = message.factor;
        this.speed = message.speed;
        const run = session.runs.find((known) => known.id === message.run);
        if (run) {
          run.trace = message.trace;
          if (run.stop !== message.stop && message.stop) session.say(message.stop);
          run.stop = message.stop;
        }
        if (wasRunning !== this.isRunning) session.tell("playing");
        session.tell("live");
        break;
      }
      case "refused":
      case "saved":
        session.say(message.message);
    }
  }

  private fresh = false;

  /** `u32`s 2, run, frames, columns, points of contact, 0; times; rows of signals; frames; how many points each frame has; points. */
  private frames(data: ArrayBuffer): void {
    const session = this.session as Session;
    const [, id, n, columns, points] = new Uint32Array(data, 0, 5) as unknown as [number, number, number, number, number];
    const run = session.runs.find((known) => known.id === id);
    if (!run) return;
    const wasAtEnd = session.run === run && (session.t >= run.end - 1e-9 || this.fresh);
    const times = new Float64Array(data, HEAD, n);
    const framesAt = HEAD + 8 * n * (1 + columns);
    const countsAt = framesAt + 4 * n * run.frames.width;
    run.times.push(times);
    run.rowTimes.push(times);
    run.rows.push(new Float64Array(data, HEAD + 8 * n, n * columns));
    run.frames.push(new Float32Array(data, framesAt, n * run.frames.width));
    run.addContacts(new Uint32Array(data, countsAt, n), new Float32Array(data, countsAt + 4 * n, CONTACT * points));
    if (this.fresh && session.run === run) {
      this.fresh = false;
      session.t = run.end;
      session.tell("runs", "properties", "plots", "live");
    }
    if (wasAtEnd) session.t = run.end;
    session.tell("frames", "time");
  }
}
