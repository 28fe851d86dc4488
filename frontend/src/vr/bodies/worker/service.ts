/**
 * The worker's side: computes each newest input and handles commands between two frames.
 *
 * With shared memory it sleeps in `Atomics.wait` and sees no messages meanwhile. A command therefore
 * raises a count in the shared memory: the worker then returns to its event loop until it has
 * handled as many, in their order, and a frame that was asked for after a command sees its effect.
 */

import type { Mujoco } from "@shared/avatar/mujoco";
import { BodiesEngine } from "../engine";
import { Reader, Writer } from "./exchange";
import {
  ANSWERED_WORD,
  BELL_WORD,
  COMMANDS_WORD,
  type Command,
  type FromWorker,
  SharedMemory,
  type ToWorker,
} from "./messages";
import { type Computed, InputSlot, ResultSlot } from "./wire";

export interface WorkerPort {
  onmessage: ((event: MessageEvent<ToWorker>) => void) | null;
  postMessage(message: FromWorker, transfer?: Transferable[]): void;
}

type Opening = Extract<ToWorker, { kind: "open" }>;

/** Serve one page; `load` starts MuJoCo from its WebAssembly. */
export function serveBodies(port: WorkerPort, load: (wasm: ArrayBuffer) => Promise<Mujoco>): void {
  let service: Service | null = null;
  const fail = (problem: unknown) => port.postMessage({ kind: "failed", problem: String(problem) });
  const open = async ({ setup, wasm, shared }: Opening) => {
    const engine = new BodiesEngine(await load(wasm), setup);
    service = new Service(port, engine, shared === null ? null : new SharedMemory(shared));
    port.postMessage({ kind: "opened" });
    service.listen();
  };
  port.onmessage = ({ data }) => {
    if (data.kind === "open") {
      open(data).catch(fail);
      return;
    }
    try {
      service?.handle(data);
    } catch (error) {
      fail(error);
    }
  };
}

class Service {
  private readonly inputs: Reader<InputSlot> | null;
  private readonly results: Writer<ResultSlot> | null;
  private handled = 0;
  private shown = 0;

  constructor(
    private readonly port: WorkerPort,
    private readonly engine: BodiesEngine,
    private readonly memory: SharedMemory | null,
  ) {
    this.inputs = memory && new Reader(memory.inputs, memory.inputSlots);
    this.results = memory && new Writer(memory.results, memory.resultSlots);
  }

  handle(message: Exclude<ToWorker, Opening>): void {
    if (message.kind === "frame") {
      this.answer(message);
      return;
    }
    this.obey(message);
    this.handled += 1;
    this.listen();
  }

  /** Compute inputs from shared memory until a command arrives. */
  listen(): void {
    const { memory, inputs, results } = this;
    if (memory === null || inputs === null || results === null) return;
    const { control } = memory;
    for (;;) {
      const bell = Atomics.load(control, BELL_WORD);
      if (Atomics.load(control, COMMANDS_WORD) !== this.handled) return;
      const input = inputs.take();
      if (input === null) {
        Atomics.store(control, ANSWERED_WORD, bell);
        Atomics.notify(control, ANSWERED_WORD);
        Atomics.wait(control, BELL_WORD, bell);
        continue;
      }
      results.slot.write(this.compute(input));
      results.publish();
    }
  }

  private obey(command: Command): void {
    const { engine } = this;
    if (command.kind === "wear") engine.wear(command.body);
    else if (command.kind === "latency") engine.setLatency(command.latencyS);
    else if (command.kind === "surfaces") {
      this.shown = command.shown;
      engine.showSurfaces(command.keys);
    } else {
      const { id, order } = command;
      const answer = (heldRad: Readonly<Record<string, number>> | null, problem: string | null) =>
        this.port.postMessage({ kind: "changed", id, heldRad, problem });
      engine.change(order, {
        onHeld: (heldRad) => answer(heldRad, null),
        onProblem: (problem) => answer(null, problem),
      });
    }
  }

  private answer({ input, result }: Extract<ToWorker, { kind: "frame" }>): void {
    new ResultSlot(result).write(this.compute(new InputSlot(input)));
    this.port.postMessage({ kind: "computed", input, result }, [input, result]);
  }

  private compute(input: InputSlot): Computed {
    const { engine, shown } = this;
    const { timeS, fingers } = input;
    engine.frame(timeS, input.readGoals(), fingers);
    const { own, worn, ikMs, remoteMs, skippedGaps } = engine;
    return {
      timeS,
      tookMs: ikMs + remoteMs,
      ikMs,
      skippedGaps,
      shown,
      local: own.pose,
      remote: worn.pose,
      localFingers: worn.fingers === null ? null : fingers,
      remoteFingers: worn.fingers,
      goalErrorsM: own.goalErrorsM,
      touched: worn.touched,
      near: worn.near,
      health: worn.health,
    };
  }
}
