/** What the page and the worker of the bodies send each other, and the memory that they share. */
import type { AvatarOrder } from "../../telemetry/wire/fromServer";
import type { BodiesSetup } from "../setup";
import { type Exchange, prepare, slotBytes, slotOffsets } from "./exchange";
import { INPUT_BYTES, InputSlot, RESULT_BYTES, ResultSlot } from "./wire";

export type ToWorker =
  | {
      readonly kind: "open";
      readonly setup: BodiesSetup;
      /** MuJoCo's WebAssembly; the worker may fetch nothing itself. */
      readonly wasm: ArrayBuffer;
      /** Null where the page may not share memory: then frames go by messages. */
      readonly shared: SharedArrayBuffer | null;
    }
  | Command
  | { readonly kind: "frame"; readonly input: ArrayBuffer; readonly result: ArrayBuffer };

/** What takes effect before the next frame; with shared memory it also rings the bell. */
export type Command =
  | { readonly kind: "wear"; readonly body: string | null }
  | { readonly kind: "latency"; readonly latencyS: number }
  | { readonly kind: "surfaces"; readonly shown: number; readonly keys: readonly string[] }
  | { readonly kind: "change"; readonly id: number; readonly order: AvatarOrder };

export type FromWorker =
  | { readonly kind: "opened" }
  | {
      readonly kind: "changed";
      readonly id: number;
      readonly heldRad: Readonly<Record<string, number>> | null;
      readonly problem: string | null;
    }
  | { readonly kind: "computed"; readonly input: ArrayBuffer; readonly result: ArrayBuffer }
  | { readonly kind: "failed"; readonly problem: string };

/** The worker as the page sees it, or a port of the same kind in a test. */
export interface BodiesPort {
  onmessage: ((event: MessageEvent<FromWorker>) => void) | null;
  postMessage(message: ToWorker, transfer?: Transferable[]): void;
  terminate(): void;
}

const CONTROL_BYTES = 64;
const INPUT_WORD = 0;
const RESULT_WORD = 1;

/** The page and the worker see the same memory. */
export class SharedMemory {
  readonly control: Int32Array;
  readonly inputs: Exchange;
  readonly results: Exchange;
  readonly inputSlots: readonly InputSlot[];
  readonly resultSlots: readonly ResultSlot[];

  constructor(buffer: SharedArrayBuffer) {
    this.control = new Int32Array(buffer, 0, CONTROL_BYTES / 4);
    this.inputs = { control: this.control, word: INPUT_WORD };
    this.results = { control: this.control, word: RESULT_WORD };
    const resultsAt = CONTROL_BYTES + slotBytes(INPUT_BYTES);
    this.inputSlots = slotOffsets(CONTROL_BYTES, INPUT_BYTES).map(
      (at) => new InputSlot(buffer, at),
    );
    this.resultSlots = slotOffsets(resultsAt, RESULT_BYTES).map((at) => new ResultSlot(buffer, at));
  }

  static make(): SharedArrayBuffer {
    const bytes = CONTROL_BYTES + slotBytes(INPUT_BYTES) + slotBytes(RESULT_BYTES);
    const buffer = new SharedArrayBuffer(bytes);
    const { inputs, results } = new SharedMemory(buffer);
    prepare(inputs);
    prepare(results);
    return buffer;
  }
}

/** Counts inputs and commands; the worker sleeps until it changes. */
export const BELL_WORD = 2;
/** Counts commands sent; the worker handles them between two frames. */
export const COMMANDS_WORD = 3;
/** What the bell counted when the worker had nothing left to do. */
export const ANSWERED_WORD = 4;
