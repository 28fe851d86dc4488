/** The values that travel between server and pages; every number carries its unit in its name. */
import type { Text } from "../text";

export type Kind = "people" | "simulated" | "test";
export type Device = "tablet" | "headset";
export type Limb = "hand" | "foot";

export interface Account {
  readonly id: string;
  readonly username: string;
  readonly role: string;
}

export interface StudySummary {
  readonly key: string;
  readonly title: string | Text;
  readonly version: number;
  readonly content_hash: string;
  readonly frozen: boolean;
  readonly session_counts: Readonly<Record<Kind, number>>;
  readonly created_at: string;
}

export interface StudyVersion {
  readonly version: number;
  readonly content_hash: string;
  readonly frozen: boolean;
  readonly created_at: string;
}

export interface StudyDetail {
  readonly key: string;
  readonly title: string | Text;
  readonly description: string | Text;
  readonly languages: readonly string[];
  readonly versions: readonly StudyVersion[];
  readonly protocol: StudyProtocol;
  readonly yaml: string;
}

export interface Condition {
  readonly key: string;
  readonly latency_ms: number;
  readonly label: Text;
}

export interface SetupStep {
  readonly step: string;
  readonly text?: string;
  readonly instrument?: string;
  readonly duration_s?: number;
  readonly latency_ms?: number;
}

export interface TaskPhase {
  readonly limb: Limb;
  readonly preparation_s: number;
  readonly duration_s: number;
  readonly freeze_s: number;
  readonly questionnaire: string | null;
}

export interface StudyProtocol {
  readonly conditions: readonly Condition[];
  readonly orders: {
    readonly design: string;
    readonly replicates: number;
    readonly seed: number;
    readonly when_full: string;
  };
  readonly procedure: {
    readonly before: readonly SetupStep[];
    readonly block: { readonly limb_order: string; readonly phases: readonly TaskPhase[] };
    readonly after: readonly SetupStep[];
  };
  readonly on_disconnect: string;
  readonly blinding: { readonly operator: boolean };
}

export interface CheckResult {
  readonly ok: boolean;
  readonly problems: readonly ConfigProblem[];
}

export interface ConfigProblem {
  readonly path: string;
  readonly line: number;
  readonly column: number;
  readonly message: string;
  readonly value?: unknown;
  readonly valid?: unknown;
  readonly remedy?: string | null;
}

export interface Attempt {
  readonly session_id: string;
  readonly participant_code: string;
  readonly outcome: string | null;
  readonly opened_at: string;
  readonly closed_at: string | null;
  readonly reason: string | null;
}

export interface Slot {
  readonly index: number;
  readonly block: number;
  readonly replicate: number;
  readonly sequence: readonly number[];
  readonly state: "free" | "open" | "completed";
  readonly attempts: readonly Attempt[];
}

export interface Ledger {
  readonly kind: Kind;
  readonly seed: number;
  readonly when_full: string;
  readonly sequences: readonly {
    readonly sequence: readonly number[];
    readonly completed: number;
    readonly open: number;
    readonly total: number;
  }[];
  readonly slots: readonly Slot[];
}

export type SessionStatus = "planned" | "active" | "completed" | "aborted" | "withdrawn";

export interface SessionSummary {
  readonly id: string;
  readonly participant_code: string;
  readonly kind: Kind;
  readonly simulated: boolean;
  readonly status: SessionStatus;
  readonly sequence: readonly number[] | null;
  readonly study_version: number;
  readonly created_at: string;
  readonly started_at: string | null;
  readonly ended_at: string | null;
}

export type StepKind =
  | "consent"
  | "form"
  | "instructions"
  | "height"
  | "materialise"
  | "free_roam"
  | "task"
  | "questionnaire"
  | "debrief";

export type StepStatus = "pending" | "current" | "done" | "skipped";

export interface Step {
  readonly index: number;
  readonly key: string;
  readonly kind: StepKind;
  readonly title: string;
  readonly block: number | null;
  readonly latency_ms: number | null;
  readonly limb: Limb | null;
  readonly duration_s: number | null;
  readonly preparation_s: number | null;
  readonly freeze_s: number | null;
  readonly instrument: string | null;
  readonly status: StepStatus;
  readonly attempt: number;
  readonly reason: string | null;
}

export type CurrentStatus = "ready" | "preparing" | "running" | "paused" | "walk_back" | "freezing";

export interface Current {
  readonly index: number;
  readonly status: CurrentStatus;
  readonly active_s: number;
  readonly duration_s: number | null;
  readonly pause_reason: string | null;
}

export interface PairedDevice {
  readonly id: string;
  readonly kind: Device;
  readonly name: string | null;
  readonly paired_at: string;
  readonly connected: boolean;
  readonly last_seen_at: string | null;
}

export interface PhaseSummary {
  readonly phase_id: string;
  readonly step_index: number;
  readonly attempt: number;
  readonly limb: Limb | null;
  readonly latency_ms: number | null;
  readonly status: string;
  readonly active_s: number;
  readonly completions: number;
  readonly side_contacts: number;
  readonly side_contact_s: number;
  readonly started_at: string | null;
  readonly ended_at: string | null;
}

export interface Note {
  readonly id: string;
  readonly text: string;
  readonly at: string;
  readonly by: string;
}

export interface AdministrationScores {
  readonly administration: string;
  readonly step_index: number;
  readonly instrument: string;
  readonly scores: Readonly<Record<string, number | null>>;
}

export type CommandType =
  | "start"
  | "complete_step"
  | "begin_phase"
  | "materialise"
  | "pause"
  | "resume"
  | "redo"
  | "skip"
  | "abort"
  | "withdraw"
  | "note";

export interface SessionView {
  readonly id: string;
  readonly study_key: string;
  readonly study_title: string;
  readonly study_version: number;
  readonly participant_code: string;
  readonly kind: Kind;
  readonly simulated: boolean;
  readonly avatar: string;
  readonly language: string;
  readonly version: number;
  readonly status: SessionStatus;
  readonly time_scale: number;
  readonly created_at: string;
  readonly started_at: string | null;
  readonly ended_at: string | null;
  readonly sequence: readonly number[] | null;
  readonly slot: {
    readonly index: number;
    readonly block: number;
    readonly replicate: number;
  } | null;
  readonly steps: readonly Step[];
  readonly current: Current | null;
  readonly allowed: readonly CommandType[];
  readonly devices: readonly PairedDevice[];
  readonly phases: readonly PhaseSummary[];
  readonly notes: readonly Note[];
  readonly scores: readonly AdministrationScores[];
}

export interface Command {
  readonly type: CommandType;
  readonly reason?: string;
  readonly text?: string;
  readonly height_m?: { readonly stated: number; readonly matched: number };
}

export interface Telemetry {
  readonly phase_id: string | null;
  readonly active_s: number;
  readonly fps: number | null;
  readonly target?: unknown;
  readonly completions?: number;
  readonly side_contacts?: number;
  readonly joint_error_deg?: Readonly<Record<string, number>>;
}

export interface Pairing {
  readonly code: string;
  readonly url: string;
  readonly qr_svg: string;
  readonly expires_at: string;
}

export interface SessionEvent {
  readonly seq: number;
  readonly type: string;
  readonly at: string;
  readonly by: string | null;
  readonly data: Readonly<Record<string, unknown>>;
}

export type ItemType = "likert" | "integer" | "number" | "text" | "boolean" | "choice";

export interface Item {
  readonly key: string;
  readonly text: Text;
  readonly type: ItemType;
  readonly required?: boolean;
  readonly minimum?: number | null;
  readonly maximum?: number | null;
  readonly unit?: string | null;
  readonly choices?: readonly Choice[] | null;
}

export interface Choice {
  readonly value: string | number;
  readonly text: Text;
}

export interface Instrument {
  readonly key: string;
  readonly version: string | number;
  readonly title: Text;
  readonly stem?: Text | null;
  readonly instructions?: Text | null;
  readonly languages: readonly string[];
  readonly items: readonly Item[];
  readonly scale?: {
    readonly minimum: number;
    readonly maximum: number;
    readonly labels: readonly Text[];
  } | null;
  readonly last?: readonly string[];
}

export interface Administration {
  readonly key: string;
  readonly step_index: number;
  readonly instrument: Instrument;
  readonly item_order: readonly string[];
  readonly seed: number;
}

export interface TabletState {
  readonly session_id: string;
  readonly language: string;
  readonly languages: readonly string[];
  readonly screen: "waiting" | "consent" | "instructions" | "form" | "finished";
  readonly title: string | null;
  readonly text: string | null;
  readonly next: string | null;
  readonly step_index?: number | null;
  readonly administration: Administration | null;
}

export type Answer = string | number | boolean | null;

export interface Submission {
  readonly idempotency_key: string;
  readonly administration: string;
  readonly answers: Readonly<Record<string, Answer>>;
  readonly shown_order: readonly string[];
  readonly seed: number;
  readonly language: string;
  readonly started_at_utc: string;
  readonly timings?: Readonly<Record<string, number>>;
}

export interface Receipt {
  readonly receipt_id: string;
  readonly stored_at: string;
  readonly duplicate: boolean;
}

export interface Dashboard {
  readonly kind: Kind;
  readonly simulated: boolean;
  readonly n_sessions: number;
  readonly figures: readonly FigureSpec[];
}

export interface FigureSpec {
  readonly key: string;
  readonly title: string;
  readonly caption: string;
  readonly figure: unknown;
}
