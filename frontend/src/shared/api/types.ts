/**
 * The values that travel between server and pages; every number carries its unit in its name.
 *
 * Shapes come from the server's own description (`schema.d.ts`, made by `npm run api`). Where that
 * says no more than "a string" or "an object", the words and shapes of the protocol are added here.
 */
import type { Text } from "../text";
import type { components } from "./schema";

type Schemas = components["schemas"];
/** A type with some of its fields told more exactly. */
type With<Type, Exact> = Readonly<Omit<Type, keyof Exact> & Exact>;

export type SessionSummary = Schemas["SessionSummary"];
export type StoredAnswers = Schemas["StoredAnswers"];
export type SessionView = Schemas["SessionView"];
export type Step = Schemas["StepView"];
export type Current = Schemas["CurrentView"];
export type PairedDevice = Schemas["DeviceView"];
export type PhaseSummary = Schemas["PhaseView"];
export type Note = Schemas["NoteView"];
export type AdministrationScores = Schemas["StoredScores"];
export type Score = Schemas["ScoreView"];
export type SessionEvent = Schemas["EventView"];
export type Alarm = Schemas["AlarmView"];
export type Preflight = Schemas["Preflight"];
export type Check = Schemas["Check"];

export type Kind = SessionSummary["kind"];
/** Sessions that are data of some sort; experts' are not. */
export type DataKind = Exclude<Kind, "expert">;
export type SessionStatus = SessionSummary["status"];
export type StepKind = Step["kind"];
export type StepStatus = Step["status"];
export type Limb = NonNullable<Step["limb"]>;
export type CurrentStatus = Current["status"];
export type Device = PairedDevice["kind"];
export type CommandType = Schemas["CommandRequest"]["type"];
/** What the operator may do now: a command, or entering a form that is due. */
export type Allowed = SessionView["allowed"][number];

/** A participant who refuses the consent of a step, or takes the refusal back. */
export type RefusalWish = Schemas["RefusalWish"];

export type Network = Schemas["NetworkView"];
export type Account = Schemas["AccountView"];
export type StudySummary = Schemas["StudySummary"];
export type StudyVersion = Schemas["VersionView"];
/** `protocol` and `yaml` are null for an operator of a blinded study. */
export type StudyDetail = With<Schemas["StudyView"], { protocol: StudyProtocol | null }>;
export type CheckResult = With<
  Schemas["CheckResult"],
  { problems: readonly ConfigProblem[]; tree?: Tree | null }
>;
/** A file as it was read, whatever is wrong with it. */
export interface Tree {
  readonly [key: string]: Value;
}
type Value = null | boolean | number | string | readonly Value[] | Tree;

export interface ConfigProblem {
  readonly path: string;
  readonly line: number;
  readonly column: number;
  readonly message: string;
  readonly value?: unknown;
  readonly valid?: unknown;
  readonly remedy?: string | null;
}

export interface Condition {
  readonly key: string;
  readonly latency_ms: number;
  readonly label: Text;
}

export interface SetupStep {
  readonly step: StepKind;
  readonly text?: string | null;
  readonly instrument?: string;
  /** Of a practice. */
  readonly limb?: Limb;
  readonly duration_s?: number;
  readonly latency_ms?: number;
  readonly title?: Text | null;
}

export interface TaskPhase {
  readonly limb: Limb;
  readonly preparation_s: number;
  readonly duration_s: number;
  readonly freeze_s: number;
  readonly questionnaire: string | null;
}

export interface StudyProtocol {
  readonly title: Text;
  readonly description: Text;
  readonly conditions: readonly Condition[];
  readonly orders: {
    readonly design: string;
    readonly replicates: number;
    readonly seed: number;
    readonly when_full: string;
    /** Of the design "explicit". */
    readonly sequences?: readonly (readonly string[])[];
  };
  readonly procedure: {
    readonly before: readonly SetupStep[];
    readonly block: {
      readonly limb_order: string;
      readonly phases: readonly TaskPhase[];
      readonly after?: readonly SetupStep[];
    };
    readonly after: readonly SetupStep[];
  };
  readonly on_disconnect: string;
  readonly blinding: { readonly operator: boolean };
}

export type Attempt = Schemas["AttemptView"];
export type Shortfall = Schemas["Shortfall"];
export type Slot = Schemas["SlotRow"];
export type SlotState = Slot["state"];
export type Ledger = Schemas["LedgerView"];

export interface Command {
  readonly type: CommandType;
  readonly reason?: string;
  readonly text?: string;
  /** The step that is meant: which one to do over, or which one a late click was for. */
  readonly step_index?: number;
  readonly height_m?: { readonly stated: number; readonly matched: number };
  readonly paper_consent?: { readonly place: string; readonly reason: string };
}

/** What the headset reports several times a second; not part of the OpenAPI description. */
export interface Telemetry {
  readonly phase_id: number;
  readonly active_s: number;
  readonly fps: number | null;
  readonly completions?: number;
  readonly side_contacts?: number;
  readonly joint_error_deg?: Readonly<Record<string, number | null>>;
}

/** How good the headset's data are; null where it is not known. Counts begin with the phase. */
export interface Signal {
  readonly frame_rate_hz: number | null;
  readonly usual_rate_hz: number | null;
  readonly gaps: number;
  readonly gap_s: number;
  readonly frames_flagged: number;
  readonly clock_uncertainty_ms: number | null;
  readonly behind_s: number;
}

/** An alarm that is on, with its newest value. */
export interface LiveAlarm extends Pick<Alarm, "code" | "severity" | "stream" | "message"> {
  readonly value: number | null;
  readonly unit: string | null;
  readonly joints: readonly string[];
  readonly since: string;
}

/** What the server tells of the headset: always how good its data are, and figures with frames. */
export interface TelemetryNews extends Partial<Telemetry> {
  readonly signal: Signal | null;
  readonly alarms: readonly LiveAlarm[];
}

/** Whether the record can be written: told when a page begins to listen, and when it changes. */
export interface StorageNews {
  readonly status: "ok" | "failing";
  readonly since: string | null;
  readonly reason: string | null;
  readonly low_disk: boolean;
}

/** What runs beside the requests on the server and fails: told when that changes. */
export interface FailingNews {
  readonly name: string;
  readonly state: "failing" | "stopped";
  readonly urgency: "critical" | "warning";
  readonly since: string;
}

export type Pairing = Schemas["PairingView"];

export type ItemType = "likert" | "integer" | "number" | "text" | "boolean" | "choice";

export interface Item {
  readonly key: string;
  readonly text: Text;
  readonly type: ItemType;
  readonly required?: boolean;
  readonly minimum?: number | null;
  readonly maximum?: number | null;
  readonly max_length?: number | null;
  readonly unit?: string | null;
  readonly choices?: readonly Choice[];
  /** Agreement speaks against what the scale measures. */
  readonly reverse_keyed?: boolean;
  /** In place of the instrument's. */
  readonly scale?: Scale | null;
}

export interface Choice {
  readonly key: string;
  readonly label: Text;
}

export interface Scale {
  readonly minimum: number;
  readonly maximum: number;
  /** One label for each step, or two for both ends, or none. */
  readonly labels: readonly Text[];
  readonly step?: number;
}

export interface Instrument {
  readonly key: string;
  readonly version: number;
  readonly title: Text;
  readonly stem?: Text | null;
  readonly instructions?: Text | null;
  readonly languages: readonly string[];
  readonly items: readonly Item[];
  readonly scale?: Scale | null;
  readonly shuffle?: boolean;
  /** Items that stay at the end when the others are shuffled. */
  readonly last?: readonly string[];
}

export type InstrumentPreview = With<Schemas["Preview"], { instrument: Instrument }>;
export type InstrumentCheck = With<
  Schemas["InstrumentCheck"],
  { problems: readonly ConfigProblem[]; preview?: InstrumentPreview | null }
>;
export type InstrumentDetail = With<Schemas["InstrumentDetail"], { preview: InstrumentPreview }>;

export type Administration = With<Schemas["Administration"], { instrument: Instrument }>;
export type TabletState = With<Schemas["TabletState"], { administration: Administration | null }>;

export type Answer = string | number | boolean | null;
export type Submission = Schemas["SubmissionRequest"];
export type Receipt = Schemas["Receipt"];

export type FigureSpec = Schemas["FigureView"];
export type CodebookColumn = Schemas["ColumnView"];
