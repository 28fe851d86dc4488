/**
 * The JSON messages that a headset sends in addition to its binary batches.
 *
 * The server closes the connection on an invalid message, and from the journal it would be resent
 * forever: so each message is checked by these schemas before it is sent or journaled.
 */
import { GOAL_PARTS } from "@shared/avatar/goals";
import * as v from "valibot";
import {
  CompletionNumber,
  Count,
  Epoch,
  MalformedMessage,
  Name20,
  Name40,
  Name120,
  Name300,
  narrowed,
  PROTOCOL_VERSION,
  Seconds,
  Seq,
} from "./basis";

const Hello = v.strictObject({
  type: v.literal("hello"),
  protocol: v.literal(PROTOCOL_VERSION),
  client: Name120,
  epoch: v.nullable(Epoch),
  /** What the client can show; only a delayed copy by default. */
  avatars: v.optional(v.pipe(v.array(Name40), v.maxLength(10))),
  /** Whether this run sends the streams of fingers with every frame; it does not by default. */
  fingers: v.optional(v.boolean()),
  /** Whether it can change a physics avatar while it runs; it cannot by default. */
  changes_avatar: v.optional(v.boolean()),
  /** Whether this run reports how the goals are known, and every change of it. */
  goals: v.optional(v.boolean()),
  /** Whether it shows the texts and forms of the state's `panel`. */
  panels: v.optional(v.boolean()),
  /** Whether it carries out the state's `calibration`. */
  calibrates: v.optional(v.boolean()),
});

/** What the headset did to the clock of a phase, at its own monotonic time. */
const PhaseReport = v.strictObject({
  kind: v.literal("phase"),
  phase_id: Count,
  what: v.picklist([
    "started",
    "paused",
    "resumed",
    "walk_back_started",
    "walk_back_ended",
    "time_up",
    "ended",
  ]),
  t_s: Seconds,
  active_s: Seconds,
  cause: Name40,
});

/** The participant pressed the grips and the avatar appeared. */
const MaterialisedReport = v.strictObject({ kind: v.literal("materialised"), t_s: Seconds });

/** A finished contact of one body part with one surface, inside one active interval. */
const ContactReport = v.strictObject({
  kind: v.literal("contact"),
  phase_id: Count,
  surface: Name40,
  surface_kind: v.picklist(["panel", "side", "target", "start"]),
  box: v.nullable(Count),
  side: v.nullable(Name20),
  body_part: Name40,
  begin_s: Seconds,
  end_s: Seconds,
  begin_active_s: Seconds,
  end_active_s: Seconds,
  effect: Name20,
});

const CompletionReport = v.strictObject({
  kind: v.literal("completion"),
  phase_id: Count,
  number: CompletionNumber,
  t_s: Seconds,
  active_s: Seconds,
  duration_s: Seconds,
  order: v.pipe(v.array(Count), v.maxLength(16)),
  out_of_order_touches: Count,
});

/** Reports that the avatar follows this revision, or why not, with the angles of its casts. */
const AvatarChangeReport = v.strictObject({
  kind: v.literal("avatar_changes"),
  revision: Count,
  t_s: Seconds,
  applied: v.boolean(),
  problem: v.nullable(Name300),
  held_rad: v.record(Name40, v.pipe(v.number(), v.minValue(-7), v.maxValue(7))),
});

const GoalKey = v.picklist(GOAL_PARTS);

/** How a goal is known: measured; computed from the other goals; or not at all at the moment. */
const GoalState = v.picklist(["tracked", "inferred", "lost"]);
export type GoalState = v.InferOutput<typeof GoalState>;

/** How every goal is known from the frame `frame_seq` on; sent at the beginning and on a change. */
const GoalsReport = v.strictObject({
  kind: v.literal("goals"),
  t_s: Seconds,
  frame_seq: Seq,
  source: Name40,
  states: v.pipe(
    v.record(GoalKey, GoalState),
    v.check(
      (states) => GOAL_PARTS.every((part) => states[part] !== undefined),
      "states must name all six goals",
    ),
  ),
});

const Metres = v.pipe(v.number(), v.finite(), v.minValue(-10), v.maxValue(10));
/** As far as a body can be built for it. */
const Stature = v.pipe(v.number(), v.finite(), v.minValue(0.5), v.maxValue(2.6));
const Length = v.pipe(v.number(), v.finite(), v.minValue(0), v.maxValue(10));
const Cosine = v.pipe(v.number(), v.finite(), v.minValue(-1.001), v.maxValue(1.001));

/** A completed calibration, used from now on; `tracker_from_goal` as docs/protocol.md says. */
const CalibrationReport = v.strictObject({
  kind: v.literal("calibration"),
  t_s: Seconds,
  /** The revision of the order that it answers; null if the headset made it by itself. */
  revision: v.nullable(Count),
  /** first, order, error or reset */
  cause: Name40,
  stature_m: Stature,
  span_m: v.nullable(Length),
  eye_height_m: v.nullable(Length),
  tracker_from_goal: v.record(
    GoalKey,
    v.strictObject({
      position_m: v.tuple([Metres, Metres, Metres]),
      rotation: v.tuple([Cosine, Cosine, Cosine, Cosine]),
    }),
  ),
  residuals_m: v.record(GoalKey, Length),
  sources: v.record(GoalKey, Name40),
  notices: v.pipe(v.array(Name40), v.maxLength(20)),
  /** Measured lengths, by the names of an avatar's segments; left out if there are none. */
  segments_m: v.optional(v.record(Name40, Length)),
});

/** How far a calibration is that is under way, for the operator to see. */
const CalibrationStepReport = v.strictObject({
  kind: v.literal("calibration_step"),
  t_s: Seconds,
  step: Name40,
  number: Count,
  total: Count,
  /** What keeps the step from being done; null while nothing does. */
  problem: v.nullable(Name40),
});

const Added = v.pipe(v.number(), v.finite(), v.minValue(0), v.maxValue(1));

/** What the headset's own computing adds to a phase's latency, and how much it took off again. */
const AddedLatencyReport = v.pipe(
  v.strictObject({
    kind: v.literal("added_latency"),
    phase_id: Count,
    t_s: Seconds,
    added_s: Added,
    compensated_s: Added,
    runs_in: v.picklist(["page", "worker"]),
  }),
  v.check((body) => body.compensated_s <= body.added_s, "compensated_s must be at most added_s"),
);

/** The participant called from inside the headset; `stop` pauses a running phase. */
const CallReport = v.strictObject({
  kind: v.literal("call"),
  t_s: Seconds,
  what: v.picklist(["stop", "help", "taken_back"]),
});

const Body = v.variant("kind", [
  AvatarChangeReport,
  GoalsReport,
  CalibrationReport,
  CalibrationStepReport,
  AddedLatencyReport,
  CallReport,
  PhaseReport,
  MaterialisedReport,
  ContactReport,
  CompletionReport,
]);
export type ReportBody = v.InferOutput<typeof Body>;

const Report = v.strictObject({ type: v.literal("report"), epoch: Epoch, seq: Seq, body: Body });
const Probe = v.strictObject({ type: v.literal("probe"), client_sent_s: Seconds });
const Produced = v.strictObject({
  type: v.literal("produced"),
  epoch: Epoch,
  streams: v.record(
    v.picklist(["target", "actual", "target_fingers", "actual_fingers", "reports"]),
    Seq,
  ),
});

/** How much the client has produced in each stream: its next seqs. */
export type Counts = v.InferOutput<typeof Produced>["streams"];

const ClientMessage = v.variant("type", [Hello, Report, Probe, Produced]);
type ClientMessage = v.InferOutput<typeof ClientMessage>;

/** The text of a message; throws MalformedMessage if the server would reject it. */
export function textOf(message: ClientMessage): string {
  return JSON.stringify(narrowed(ClientMessage, message));
}

/**
 * The reading of one exchange: the server's clock as the received digits, which exceed a double's
 * precision.
 */
export interface Reading {
  readonly serverReceivedNs: string;
  readonly serverSentNs: string;
  readonly clientReceivedS: number;
}

/** The text of a reading; `null` for one that did not arrive in time. */
export function probedText(clientSentS: number, reading: Reading | null): string {
  const times = {
    server_received_ns: digits(reading?.serverReceivedNs),
    server_sent_ns: digits(reading?.serverSentNs),
    client_received_s: number(reading?.clientReceivedS),
  };
  const fields = Object.entries(times).map(([name, value]) => `"${name}":${value}`);
  return `{"type":"probed","client_sent_s":${number(clientSentS)},${fields.join(",")}}`;
}

function digits(text: string | undefined): string {
  if (text === undefined) return "null";
  if (!/^\d{1,19}$/.test(text)) throw new MalformedMessage(`${text} are no nanoseconds`);
  return text;
}

const number = (timeS: number | undefined): string =>
  timeS === undefined ? "null" : JSON.stringify(narrowed(Seconds, timeS));
