/**
 * Bodies computed in a worker, so that neither the page's policy has to allow code made from text
 * nor a slow step of the simulation delays a frame.
 *
 * Each result is shown in the frame after its own: one frame is added to the latency. Where the page
 * is isolated, both threads share memory, and the newest input and result win; otherwise one message
 * is in flight, and the newest input waits for its answer. Nothing queues up either way: queues fell
 * behind by 80 ms and more.
 */
import { FINGER_PARTS, JOINTS } from "@shared/avatar/anatomy.generated";
import { GOAL_PARTS } from "@shared/avatar/goals";
import type { AvatarOrder } from "../telemetry/wire/fromServer";
import { type Bodies, type BodiesFrame, type BodiesInput, CannotChange } from "./bodies";
import { partsOf } from "./parts";
import type { BodiesSetup } from "./setup";
import { Reader, Writer } from "./worker/exchange";
import {
  ANSWERED_WORD,
  BELL_WORD,
  type BodiesPort,
  COMMANDS_WORD,
  type Command,
  type FromWorker,
  SharedMemory,
} from "./worker/messages";
import { INPUT_BYTES, InputSlot, RESULT_BYTES, ResultSlot } from "./worker/wire";

const FIRST_INTERVAL_S = 1 / 90;
/** An age beyond this is a gap, not what the worker adds. */
const OLDEST_S = 0.1;
/** A worker that has failed answers nothing; who waits for it looks again. */
const LONGEST_WAIT_MS = 100;
/** Share of a new frame in the running mean of what the worker adds. */
const NEW_SHARE = 0.05;

/** Fetch what the bodies need while nobody waits for it. */
export async function fetchBodiesBeforehand(): Promise<void> {
  const { fetchBeforehand } = await import("./worker/start");
  await fetchBeforehand();
}

/** Start the worker and make the bodies in it. */
export async function openBodiesInWorker(setup: BodiesSetup): Promise<BodiesInWorker> {
  const { startWorker } = await import("./worker/start");
  const { port, wasm } = await startWorker();
  return BodiesInWorker.open(port, setup, wasm);
}

type Shown = { -readonly [Key in keyof BodiesFrame]: BodiesFrame[Key] };
type Held = Readonly<Record<string, number>>;
interface Waiting {
  readonly resolve: (heldRad: Held) => void;
  readonly reject: (reason: Error) => void;
}

export class BodiesInWorker implements Bodies {
  readonly touchingParts: readonly string[];
  skippedGaps = 0;
  private readonly frames: Frames;
  private readonly shown: Shown;
  private readonly health = {
    restored: 0,
    resets: 0,
    ignoredInputs: 0,
    limitedTargets: 0,
    teleports: 0,
  };
  private readonly localFingers = new Float64Array(4 * FINGER_PARTS.length);
  private readonly remoteFingers = new Float64Array(4 * FINGER_PARTS.length);
  private readonly changes = new Map<number, Waiting>();
  private touched = new Uint8Array(0);
  private near = new Uint8Array(0);
  private surfaces = 0;
  private orderedS = 0;
  private ageS = FIRST_INTERVAL_S;
  private taken = FIRST_INTERVAL_S;
  private hasFrame = false;
  private failure: string | null = null;

  /** Make the bodies behind a port; `share` is false to send frames by messages. */
  static async open(
    port: BodiesPort,
    setup: BodiesSetup,
    wasm: ArrayBuffer,
    share = globalThis.crossOriginIsolated === true,
  ): Promise<BodiesInWorker> {
    const shared = share ? SharedMemory.make() : null;
    const opened = new Promise<void>((resolve, reject) => {
      port.onmessage = ({ data }) => {
        if (data.kind === "opened") resolve();
        else if (data.kind === "failed") reject(new Error(data.problem));
      };
    });
    port.postMessage({ kind: "open", setup, wasm, shared }, [wasm]);
    try {
      await opened;
    } catch (error) {
      port.terminate();
      throw error;
    }
    return new BodiesInWorker(port, setup, shared);
  }

  private constructor(
    private readonly port: BodiesPort,
    setup: BodiesSetup,
    shared: SharedArrayBuffer | null,
  ) {
    this.touchingParts = partsOf(setup);
    this.frames = shared === null ? new FramesByMessage(port) : new FramesInMemory(shared);
    const pose = 3 + 4 * JOINTS.length;
    this.shown = {
      timeS: 0,
      local: new Float64Array(pose),
      remote: new Float64Array(pose),
      localFingers: null,
      remoteFingers: null,
      goalErrorsM: new Float64Array(GOAL_PARTS.length),
      touched: this.touched,
      near: this.near,
      tookMs: 0,
      ikMs: 0,
      health: this.health,
    };
    port.onmessage = ({ data }) => this.receive(data);
  }

  /** What was taken off the ordered latency, where that is long enough. */
  get addedS(): number {
    return this.taken;
  }

  wear(body: string | null): void {
    this.command({ kind: "wear", body });
  }

  setLatency(orderedS: number): void {
    this.orderedS = orderedS;
    this.taken = this.ageS;
    this.command({ kind: "latency", latencyS: Math.max(this.orderedS - this.taken, 0) });
  }

  showSurfaces(keys: readonly string[]): void {
    this.surfaces += 1;
    const bytes = keys.length * this.touchingParts.length;
    this.touched = new Uint8Array(bytes);
    this.near = new Uint8Array(bytes);
    this.command({ kind: "surfaces", shown: this.surfaces, keys });
  }

  change(order: AvatarOrder): Promise<Held> {
    const id = order.revision;
    this.changes.get(id)?.reject(new CannotChange("The change was ordered anew."));
    return new Promise((resolve, reject) => {
      this.changes.set(id, { resolve, reject });
      this.command({ kind: "change", id, order });
    });
  }

  step({ timeS, goals, fingers }: BodiesInput): void {
    if (this.failure !== null) throw new Error(this.failure);
    const result = this.frames.take();
    if (result !== null) this.show(result, timeS);
    this.frames.slot.write(timeS, goals, fingers);
    this.frames.publish();
  }

  latest(): BodiesFrame | null {
    return this.hasFrame ? this.shown : null;
  }

  /** Whether the worker has answered every frame and command. */
  get isIdle(): boolean {
    return this.frames.isIdle || this.failure !== null;
  }

  /** Resolves when the worker has answered every frame and command: for clocks that tests step. */
  async idle(): Promise<void> {
    while (!this.isIdle) await this.frames.nextAnswer();
  }

  dispose(): void {
    this.port.terminate();
    for (const held of this.changes.values()) {
      held.reject(new CannotChange("The bodies were taken away before the change."));
    }
    this.changes.clear();
    this.failure ??= "The bodies are not there any more.";
  }

  private show(result: ResultSlot, timeS: number): void {
    const { shown } = this;
    shown.timeS = result.timeS;
    shown.tookMs = result.tookMs;
    shown.ikMs = result.ikMs;
    result.readPoses(shown.local, shown.remote, shown.goalErrorsM);
    result.readHealth(this.health);
    this.skippedGaps = result.skippedGaps;
    shown.localFingers = result.hasFingers ? this.localFingers : null;
    shown.remoteFingers = result.hasFingers ? this.remoteFingers : null;
    if (result.hasFingers) result.readFingers(this.localFingers, this.remoteFingers);
    // A result of before the surfaces were shown says nothing about them.
    const isCurrent = result.shown === this.surfaces && result.touchBytes === this.touched.length;
    shown.touched = isCurrent ? this.touched : NOTHING;
    shown.near = isCurrent ? this.near : NOTHING;
    if (isCurrent) result.readTouches(this.touched, this.near);
    const ageS = timeS - result.timeS;
    if (ageS > 0 && ageS < OLDEST_S) this.ageS += NEW_SHARE * (ageS - this.ageS);
    this.hasFrame = true;
  }

  private command(command: Command): void {
    this.frames.beforeCommand();
    this.port.postMessage(command);
    this.frames.afterCommand();
  }

  private receive(message: FromWorker): void {
    if (message.kind === "failed") {
      this.failure = `The worker of the bodies has failed: ${message.problem}`;
      for (const held of this.changes.values()) held.reject(new Error(this.failure));
      this.changes.clear();
    } else if (message.kind === "changed") {
      const held = this.changes.get(message.id);
      this.changes.delete(message.id);
      if (message.heldRad !== null) held?.resolve(message.heldRad);
      else held?.reject(new CannotChange(message.problem ?? "The body cannot be changed so."));
    } else if (message.kind === "computed") this.frames.answered(message);
  }
}

const NOTHING = new Uint8Array(0);

/** How inputs and results travel. */
interface Frames {
  /** Where the next input is written. */
  readonly slot: InputSlot;
  readonly isIdle: boolean;
  /** Resolves when the worker may have become idle, without asking for it all the time. */
  nextAnswer(): Promise<unknown>;
  publish(): void;
  /** The newest result that was not taken yet. */
  take(): ResultSlot | null;
  beforeCommand(): void;
  afterCommand(): void;
  answered(message: Computed): void;
}

type Computed = Extract<FromWorker, { kind: "computed" }>;

class FramesInMemory implements Frames {
  private readonly control: Int32Array;
  private readonly writer: Writer<InputSlot>;
  private readonly reader: Reader<ResultSlot>;

  constructor(shared: SharedArrayBuffer) {
    const memory = new SharedMemory(shared);
    this.control = memory.control;
    this.writer = new Writer(memory.inputs, memory.inputSlots);
    this.reader = new Reader(memory.results, memory.resultSlots);
  }

  get slot(): InputSlot {
    return this.writer.slot;
  }

  get isIdle(): boolean {
    const { control } = this;
    return Atomics.load(control, ANSWERED_WORD) === Atomics.load(control, BELL_WORD);
  }

  async nextAnswer(): Promise<unknown> {
    const { control } = this;
    const answered = Atomics.load(control, ANSWERED_WORD);
    if (Atomics.load(control, BELL_WORD) === answered) return undefined;
    // Asking again and again takes a processor that the worker may need.
    if (!("waitAsync" in Atomics)) return new Promise((resolve) => setTimeout(resolve, 0));
    return Atomics.waitAsync(control, ANSWERED_WORD, answered, LONGEST_WAIT_MS).value;
  }

  publish(): void {
    this.writer.publish();
    this.ring();
  }

  take(): ResultSlot | null {
    return this.reader.take();
  }

  beforeCommand(): void {
    Atomics.add(this.control, COMMANDS_WORD, 1);
  }

  afterCommand(): void {
    this.ring();
  }

  answered(): void {}

  private ring(): void {
    Atomics.add(this.control, BELL_WORD, 1);
    Atomics.notify(this.control, BELL_WORD);
  }
}

/**
 * One input and one result are in flight; an input that a newer one replaces is never sent, and so
 * is a result that is not taken never shown.
 */
class FramesByMessage implements Frames {
  private next = new InputSlot(new ArrayBuffer(INPUT_BYTES));
  private spare = new ArrayBuffer(INPUT_BYTES);
  /** One buffer is in flight, one may hold the newest result, and one that which is shown. */
  private readonly free = [new ArrayBuffer(RESULT_BYTES), new ArrayBuffer(RESULT_BYTES)];
  private newest: ArrayBuffer | null = null;
  private taken: ArrayBuffer | null = null;
  private isInFlight = false;
  private isWaiting = false;
  private onAnswer: (() => void)[] = [];

  constructor(private readonly port: BodiesPort) {}

  get slot(): InputSlot {
    return this.next;
  }

  get isIdle(): boolean {
    return !this.isInFlight;
  }

  publish(): void {
    if (this.taken !== null) this.free.push(this.taken);
    this.taken = null;
    if (this.isInFlight) this.isWaiting = true;
    else this.send();
  }

  nextAnswer(): Promise<unknown> {
    return new Promise<void>((resolve) => {
      this.onAnswer.push(resolve);
      setTimeout(resolve, LONGEST_WAIT_MS);
    });
  }

  take(): ResultSlot | null {
    this.taken = this.newest;
    this.newest = null;
    return this.taken && new ResultSlot(this.taken);
  }

  answered({ input, result }: Computed): void {
    if (this.newest !== null) this.free.push(this.newest);
    this.spare = input;
    this.newest = result;
    this.isInFlight = false;
    if (this.isWaiting) this.send();
    for (const resolve of this.onAnswer.splice(0)) resolve();
  }

  beforeCommand(): void {}

  afterCommand(): void {}

  private send(): void {
    const input = this.next.buffer;
    const result = this.free.pop() ?? new ArrayBuffer(RESULT_BYTES);
    this.next = new InputSlot(this.spare);
    this.isInFlight = true;
    this.isWaiting = false;
    this.port.postMessage({ kind: "frame", input, result }, [input, result]);
  }
}
