/** The telemetry client of the headset's page: `docs/protocol.md` in TypeScript. */
export type { Level, Status, TelemetryClient, TelemetryOptions } from "./client";
export type { Abilities, Notice } from "./connection/connection";
export { type Failure, TelemetryError } from "./failure";
export { deleteJournal, type LeftJournal, leftJournals } from "./journal/indexedDb";
export { TrialJournal } from "./journal/trial";
export { DEFAULT_LIMITS, type Limits } from "./limits";
export { openTelemetry, type Surroundings } from "./open";
export { flushWhenLeft, openTelemetryInWorker } from "./page";
export { SUBPROTOCOL } from "./wire/basis";
export {
  ACTIVE,
  encodeBatch,
  FINGER_VALUES_PER_FRAME,
  type Frames,
  type StreamName,
  VALUES_PER_FRAME,
} from "./wire/batch";
export type { GoalState, ReportBody } from "./wire/fromClient";
export type {
  AvatarOrder,
  CalibrationOrder,
  HeadsetState,
  PanelOrder,
  PhaseOrder,
  Road,
  Welcome,
} from "./wire/fromServer";
export { serverMessage } from "./wire/fromServer";
