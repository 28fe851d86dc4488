/** The worker's side: opens bodies, obeys commands and simulates as much as it is asked for. */
import type { Mujoco } from "@shared/avatar/mujoco";
import { SimulationError } from "@shared/avatar/physics/modelTable";
import type { Command } from "../physics/commands";
import type { BodyToTry } from "../physics/triedBody";
import { Tryout } from "../physics/tryout";
import type { FromWorker, ToWorker } from "./messages";

export interface WorkerPort {
  onmessage: ((event: MessageEvent<ToWorker>) => void) | null;
  postMessage(message: FromWorker, transfer?: Transferable[]): void;
}

/** Serve one page; `load` starts MuJoCo from its WebAssembly. */
export function serveTryout(port: WorkerPort, load: (wasm: ArrayBuffer) => Promise<Mujoco>): void {
  const service = new Service(port);
  // Messages that arrive while MuJoCo is loaded wait for it.
  let turn: Promise<void> = Promise.resolve();
  port.onmessage = ({ data }) => {
    turn = turn
      .then(async () => {
        if (data.kind === "open") service.mujoco = await load(data.wasm);
        service.handle(data);
      })
      .catch((problem: unknown) => port.postMessage({ kind: "failed", problem: wordsOf(problem) }));
  };
}

const wordsOf = (problem: unknown): string =>
  problem instanceof Error ? problem.message : String(problem);

class Service {
  mujoco: Mujoco | null = null;
  private tryout: Tryout | null = null;
  private readonly standing = new Map<Command["kind"], Command>();

  constructor(private readonly port: WorkerPort) {}

  handle(message: ToWorker): void {
    if (message.kind === "open") this.open(message.bodies);
    else if (message.kind === "change") this.change(message.bodies);
    else if (message.kind === "command") this.obey(message.command);
    else this.advance(message.ticks, message.axis, message.part);
  }

  private open(bodies: readonly BodyToTry[]): void {
    if (this.mujoco === null) throw new Error("MuJoCo has not been loaded.");
    const next = new Tryout(this.mujoco, bodies);
    this.tryout?.dispose();
    this.tryout = next;
    // What was chosen while it was opened holds, as far as it can.
    for (const command of this.standing.values()) this.obey(command);
    next.obey({ kind: "reset" });
    this.tellOpened(next);
  }

  private change(bodies: readonly BodyToTry[]): void {
    const { tryout } = this;
    if (tryout === null) throw new Error("No body has been opened.");
    const problems = tryout.change(bodies, this.standing.values());
    this.tellOpened(tryout);
    for (const problem of problems) this.refuse(problem);
  }

  private tellOpened(tryout: Tryout): void {
    const { longestLatencyS } = tryout;
    this.port.postMessage({ kind: "opened", shapes: tryout.shapes(), longestLatencyS });
  }

  private obey(command: Command): void {
    const { kind } = command;
    if (kind === "drive" || kind === "play") {
      this.standing.delete(kind === "drive" ? "play" : "drive");
      this.standing.set(kind, command);
    } else if (kind === "latency" || kind === "gravity" || kind === "pose") {
      this.standing.set(kind, command);
    }
    try {
      this.tryout?.obey(command);
    } catch (error) {
      this.standing.delete(kind);
      this.refuse(error);
    }
  }

  /** Tell of a command that could not be obeyed. */
  private refuse(problem: unknown): void {
    if (!(problem instanceof SimulationError)) throw problem;
    this.port.postMessage({ kind: "refused", problem: problem.message });
  }

  private advance(ticks: number, axis: string, part: string | undefined): void {
    const { tryout } = this;
    if (tryout === null) return;
    const begin = performance.now();
    const bodies = tryout.advance(ticks, axis, part);
    const tookMs = performance.now() - begin;
    this.port.postMessage(
      { kind: "advanced", advance: { ticks, axis, timeS: tryout.timeS, tookMs, bodies } },
      bodies.flatMap(({ places, readings }) => [places.buffer, readings.buffer] as ArrayBuffer[]),
    );
  }
}
