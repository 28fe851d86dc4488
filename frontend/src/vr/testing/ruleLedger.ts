/**
 * Notes everything that is handed to the task rules of the page, for tests that hand the same to the
 * server's rules and compare what comes of it.
 */
import type { BoxRun } from "../tasks";
import type { Touches } from "../tasks/contacts";
import type { TimedRun } from "../tasks/phases/timedRun";
import type { CommandKind } from "../tasks/state";
import type { PhaseOrder } from "../telemetry";

/** A command of the clock, or what touched and was near in a frame, as indices into the tables. */
type RuleInput =
  | { readonly timeS: number; readonly command: CommandKind }
  | {
      readonly timeS: number;
      readonly touched: readonly number[];
      readonly near: readonly number[];
    };

/** The inputs of one phase in one run of the page, in their order. */
export interface RuleRecord {
  readonly epoch: number;
  /** The order with which the phase was entered; its active time is that of earlier runs. */
  order: PhaseOrder;
  readonly writingHand: string;
  /** The parts of the avatar, in the order of the tables: surfaces by parts. */
  readonly parts: readonly string[];
  /** Frames handed over; `inputs` has those in which something changed. */
  frames: number;
  readonly inputs: RuleInput[];
}

/** The methods that a run gives its inputs to; protected, because only the run calls them. */
interface Inputs {
  readonly spentS: number;
  command(kind: CommandKind, timeS: number): void;
  touch(timeS: number, touches: Touches): void;
}

export class RuleLedger {
  readonly records: RuleRecord[] = [];
  #watched: TimedRun | null = null;

  /** Call after every frame: a run is watched from the frame on in which its phase was entered. */
  watch(run: TimedRun | null, epoch: number, parts: readonly string[]): void {
    if (run === this.#watched) return;
    this.#watched = run;
    if (run !== null && "state" in run) this.#begin(run as BoxRun, epoch, parts);
  }

  /** Let the inputs so far go; the phase that runs is watched on. */
  forget(): void {
    for (const { inputs } of this.records) inputs.length = 0;
  }

  #begin(run: BoxRun, epoch: number, parts: readonly string[]): void {
    const inputs: RuleInput[] = [];
    const record: RuleRecord = {
      epoch,
      order: run.order,
      writingHand: run.state.rules.writingHand,
      parts,
      frames: 0,
      inputs,
    };
    this.records.push(record);
    const { lastS } = run.clock;
    if (lastS !== null) {
      // A run that takes over starts and stops its clock in the frame in which it is entered.
      if (run.clockRuns) throw new Error("The ledger needs a phase with a preparation.");
      inputs.push({ timeS: lastS, command: "start" }, { timeS: lastS, command: "pause" });
    }
    const rules = run as unknown as Inputs;
    const { command, touch } = rules;
    rules.command = (kind, timeS) => {
      // Who takes over may hear only now how much active time the run before has used.
      record.order = { ...record.order, active_s: rules.spentS };
      inputs.push({ timeS, command: kind });
      command.call(run, kind, timeS);
    };
    let before = "";
    rules.touch = (timeS, touches) => {
      const [touched, near] = [indicesOf(touches.touched), indicesOf(touches.near)];
      const now = `${touched}/${near}`;
      if (now !== before) inputs.push({ timeS, touched, near });
      before = now;
      record.frames++;
      touch.call(run, timeS, touches);
    };
  }
}

function indicesOf(table: Uint8Array): readonly number[] {
  const found: number[] = [];
  for (let index = 0; index < table.length; index++) if (table[index] !== 0) found.push(index);
  return found;
}
