/** Why nothing more can be sent: in the server's words if it gave any. */
export interface Failure {
  /** For programs: the server's code, or one of this client's own. */
  readonly code: string;
  readonly message: string;
  readonly remedy: string;
}

/** Thrown by calls that send or wait after the failure. The journal keeps its contents. */
export class TelemetryError extends Error {
  override readonly name = "TelemetryError";
  readonly failure: Failure;

  constructor(failure: Failure) {
    super(failure.remedy === "" ? failure.message : `${failure.message}. ${failure.remedy}`);
    this.failure = failure;
  }
}

export const CLOSED: Failure = {
  code: "closed",
  message: "the telemetry client was closed",
  remedy: "",
};
