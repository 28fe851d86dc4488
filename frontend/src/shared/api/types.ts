/**
 * The values exchanged between server and pages; every number has its unit in its name.
 *
 * Shapes come from the server's own description (`schema.d.ts`, made by `npm run api`). Where that
 * says no more than "a string" or "an object", the words and shapes of the protocol are added here.
 */
import type { Text } from "../text";
import type { components } from "./schema";

type Schemas = components["schemas"];
/** A type in which some fields have a narrower type. */
type With<Type, Exact> = Readonly<Omit<Type, keyof Exact> & Exact>;

export type SessionSummary = Schemas["ListedSession"];
export type StoredAnswers = Schemas["StoredAnswers"];
export type SessionView = Schemas["SessionView"];
export type Step = Schemas["StepView"];
export type Current = Schemas["CurrentView"];
/** What a session's record has and lacks, computed from the record. */
export type SessionReceipt = Schemas["SessionReceipt"];
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
/** Kinds of sessions whose data are analysed; experts' sessions are not. */
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

/** The participant's refusal of a consent step, or its retraction. */
export type RefusalWish = Schemas["RefusalWish"];

export type Network = Schemas["NetworkView"];
export type Account = Schemas["AccountView"];
export type StudySummary = Schemas["StudySummary"];
export type StudyVersion = Schemas["VersionView"];
/** `protocol` and `yaml` are null for the operator of a blinded study. */
export type StudyDetail = With<Schemas["StudyView"], { protocol: StudyProtocol | null }>;
export type CheckResult = With<
  Schemas["CheckResult"],
  { problems: readonly ConfigProblem[]; tree?: Tree | null }
>;
/** A study file as it was parsed, whether valid or not. */
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
  /** The body that participants wear in it; without it that of the avatar's configuration. */
  readonly body?: string;
  readonly label: Text;
}

export interface SetupStep {
  readonly step: StepKind;
  readonly text?: string | null;
  readonly instrument?: string;
  /** Only for a practice. */
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

/** The phase on the study's road: it ends after so many crossings, or when its time is over. */
export interface CrossingPhase extends Omit<TaskPhase, "limb"> {
  readonly crossings: number;
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
    /** Only for the design "explicit". */
    readonly sequences?: readonly (readonly string[])[];
  };
  readonly procedure: {
    readonly before: readonly SetupStep[];
    readonly block: {
      readonly limb_order: string;
      readonly phases: readonly TaskPhase[];
      /** Only for a study with a road: it comes first. */
      readonly crossing?: CrossingPhase;
      readonly after?: readonly SetupStep[];
    };
    readonly after: readonly SetupStep[];
  };
  readonly avatar?: string;
  /** The saved avatar that is worn; only for the physics avatar. */
  readonly avatar_configuration?: { readonly key: string; readonly version: number } | null;
  readonly on_disconnect: string;
  readonly blinding: { readonly operator: boolean };
}

export type Attempt = Schemas["AttemptView"];
export type Shortfall = Schemas["Shortfall"];
export type Slot = Schemas["SlotRow"];
export type SlotState = Slot["state"];
export type Ledger = Schemas["LedgerView"];

export type AvatarChanges = Partial<NonNullable<Schemas["CommandRequest"]["avatar_changes"]>>;
export type AvatarChangesInForce = NonNullable<SessionView["avatar_changes"]>;
export type AvatarChoices = Schemas["AvatarChoices"];

export interface Command {
  readonly type: CommandType;
  readonly reason?: string;
  readonly text?: string;
  /** The step the command is about: the one to repeat, or the one that was current on the page. */
  readonly step_index?: number;
  readonly height_m?: { readonly stated: number; readonly matched: number };
  readonly paper_consent?: { readonly place: string; readonly reason: string };
  readonly avatar_changes?: AvatarChanges;
  readonly tracker_shift?: Schemas["TrackerShift"];
}

/** What the headset reports several times a second; not part of the OpenAPI description. */
export interface Telemetry {
  readonly phase_id: number;
  readonly active_s: number;
  readonly fps: number | null;
  readonly completions?: number;
  readonly side_contacts?: number;
  /** Of the contacts that have ended. */
  readonly side_contact_s?: number;
  readonly joint_error_deg?: Readonly<Record<string, number | null>>;
}

/**
 * How good the headset's data are; null if unknown. Counts start with the phase. For blinded readers,
 * only the participant's own frames are counted as flagged.
 */
export interface Signal {
  readonly frame_rate_hz: number | null;
  readonly usual_rate_hz: number | null;
  readonly gaps: number;
  readonly gap_s: number;
  readonly frames_flagged: number;
  readonly clock_uncertainty_ms: number | null;
  readonly behind_s: number;
}

/** An active alarm with its newest value. */
export interface LiveAlarm extends Pick<Alarm, "code" | "severity" | "stream" | "message"> {
  readonly value: number | null;
  readonly unit: string | null;
  readonly joints: readonly string[];
  readonly since: string;
}

/**
 * A live message about the headset: always its data quality, and figures if there are new frames.
 */
export interface TelemetryNews extends Partial<Telemetry> {
  readonly signal: Signal | null;
  readonly alarms: readonly LiveAlarm[];
}

/** Whether the record can be written: sent when a page subscribes and whenever it changes. */
export interface StorageNews {
  readonly status: "ok" | "failing";
  readonly since: string | null;
  readonly reason: string | null;
  readonly low_disk: boolean;
}

/** The server's failing background tasks: sent whenever they change. */
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
  /** Agreement counts against what the scale measures. */
  readonly reverse_keyed?: boolean;
  /** Replaces the instrument's scale. */
  readonly scale?: Scale | null;
}

export interface Choice {
  readonly key: string;
  readonly label: Text;
}

export interface Scale {
  readonly minimum: number;
  readonly maximum: number;
  /** One label for each step, or two for the ends, or none. */
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
export type FormStored = With<Schemas["FormStored"], { state: TabletState }>;

export type FigureSpec = Schemas["FigureView"];
export type CodebookColumn = Schemas["ColumnView"];
