/** The messages between the page and its worker. */
import type { Status, TelemetryOptions } from "./client";
import type { Notice } from "./connection/connection";
import type { Failure } from "./failure";
import type { Frames, StreamName } from "./wire/batch";
import type { ReportBody } from "./wire/fromClient";
import type { HeadsetState, Welcome } from "./wire/fromServer";

/** A method call on the client; it is answered under its id. */
export type Call =
  | { readonly what: "sendFrames"; readonly stream: StreamName; readonly frames: Frames }
  | { readonly what: "report"; readonly body: ReportBody }
  | { readonly what: "drained" | "flush" | "close" };

export type ToWorker =
  | {
      readonly kind: "open";
      readonly options: TelemetryOptions;
      /** `performance.timeOrigin` of the page, whose clock the client's times refer to. */
      readonly timeOriginMs: number;
    }
  | { readonly kind: "giveUp" }
  | { readonly kind: "call"; readonly id: number; readonly call: Call };

/** An error as it is passed between threads: its message, and the failure if it has one. */
export interface PortError {
  readonly name: string;
  readonly message: string;
  readonly failure: Failure | null;
}

export type FromWorker =
  | { readonly kind: "opened"; readonly welcome: Welcome; readonly state: HeadsetState }
  | { readonly kind: "refused"; readonly wrong: PortError }
  | { readonly kind: "done"; readonly id: number; readonly wrong: PortError | null }
  | { readonly kind: "state"; readonly state: HeadsetState; readonly welcome: Welcome }
  | { readonly kind: "status"; readonly status: Status }
  | { readonly kind: "notice"; readonly notice: Notice };

/** One end: a worker seen from the page, the worker's own scope, or a MessagePort. */
export interface Port<Out, In> {
  postMessage(message: Out, transfer: Transferable[]): void;
  addEventListener(type: "message", listener: (event: MessageEvent<In>) => void): void;
}
