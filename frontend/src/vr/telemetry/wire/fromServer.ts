/**
 * The JSON messages of the server, parsed from text.
 *
 * Unknown fields are dropped, and so are messages of an unknown type: a newer server may send more.
 * A
 * message of a known type with a missing field is an error.
 */
import * as v from "valibot";
import { MalformedMessage, narrowed } from "./basis";

const whole = v.pipe(v.number(), v.integer());

/** All of `seq < next_seq` of a stream is on disk. */
const StreamPosition = v.object({ stream: v.string(), epoch: whole, next_seq: whole });
export type StreamPosition = v.InferOutput<typeof StreamPosition>;

/** The phase to run; the headset converges to it. The latency is known here and nowhere else. */
const PhaseOrder = v.object({
  phase_id: whole,
  kind: v.string(),
  limb: v.nullable(v.string()),
  status: v.string(),
  latency_ms: v.number(),
  preparation_s: v.number(),
  duration_s: v.number(),
  freeze_s: v.number(),
  active_s: v.number(),
  completions: whole,
  pausing: v.boolean(),
  resuming: v.boolean(),
  // The phase ends once so many tasks or crossings are completed; an older server does not send it.
  until_completions: v.optional(v.nullable(whole), null),
  /** The participant crosses the welcome's road; left out if not. */
  has_road: v.optional(v.boolean()),
  /** The body to wear, one of the welcome's `bodies`; left out for that of the configuration. */
  body: v.optional(v.string()),
});
export type PhaseOrder = v.InferOutput<typeof PhaseOrder>;

/**
 * How the avatar differs from its configuration now; the client brings its body to it. Only sent
 * once something was changed.
 */
const AvatarOrder = v.object({
  revision: whole,
  gravity: v.nullable(v.boolean()),
  self_collision: v.nullable(v.boolean()),
  colliders: v.record(v.string(), v.picklist(["simple", "mesh", "none"])),
  layers: v.array(v.object({ layers: v.tuple([v.string(), v.string()]), collide: v.boolean() })),
  held_rad: v.record(v.string(), v.nullable(v.number())),
  motors: v.record(
    v.string(),
    v.object({
      kp_nm_per_rad: v.number(),
      kd_nm_s_per_rad: v.number(),
      max_torque_nm: v.number(),
    }),
  ),
});
export type AvatarOrder = v.InferOutput<typeof AvatarOrder>;

/** How the calibration should differ from the headset's own; replaces earlier orders. */
const CalibrationOrder = v.object({
  revision: whole,
  /** Calibrate again now, and report it with this revision. */
  calibrate: v.boolean(),
  /** Goal -> shift of the part's joint, in the axes that the part has in the T-pose. */
  shifts_m: v.record(v.string(), v.tuple([v.number(), v.number(), v.number()])),
});
export type CalibrationOrder = v.InferOutput<typeof CalibrationOrder>;

/** What the participant should read, answer or do beside the scene, in the session's language. */
const PanelOrder = v.object({
  language: v.string(),
  title: v.nullable(v.string()),
  text: v.nullable(v.string()),
  /** The key of the form to fill in inside the headset; `GET /api/vr/form` returns it. */
  form: v.nullable(v.string()),
  /** Where the current form is answered; null if none is due. */
  answer: v.nullable(v.picklist(["headset", "tablet", "oral"])),
  /** The participant may complete the step by `POST /api/vr/acknowledge`, having read its text. */
  acknowledge: v.boolean(),
  headset_off: v.boolean(),
  held: v.boolean(),
  called: v.boolean(),
  /** What the current step's task is done with; left out if it is no task. */
  limb: v.optional(v.picklist(["hand", "foot"])),
  /** The study's words for `freeze` and `walk_back`; an older server does not send them. */
  screen_texts: v.optional(v.record(v.string(), v.string())),
});
export type PanelOrder = v.InferOutput<typeof PanelOrder>;

/** The state of the session, as the headset needs it. */
const HeadsetState = v.object({
  type: v.literal("state"),
  version: whole,
  status: v.string(),
  step_index: v.nullable(whole),
  step_kind: v.nullable(v.string()),
  materialised: v.boolean(),
  recording: v.boolean(),
  phase: v.nullable(PhaseOrder),
  participant: v.object({
    handedness: v.nullable(v.string()),
    footedness: v.nullable(v.string()),
    stature_m: v.nullable(v.number()),
  }),
  avatar_changes: v.optional(AvatarOrder),
  /** Only for clients that said `panels`. */
  panel: v.optional(PanelOrder),
  /** Only for clients that said `calibrates`, once something was ordered. */
  calibration: v.optional(CalibrationOrder),
});
export type HeadsetState = v.InferOutput<typeof HeadsetState>;

/** A study's road (docs/protocol.md, section 12). */
const Road = v.object({
  road: v.object({
    half_length_m: v.number(),
    lane_width_m: v.number(),
    pavement_width_m: v.number(),
    crossing_width_m: v.nullable(v.number()),
  }),
  kerb_height_m: v.number(),
  starts_behind_kerb_m: v.number(),
  step_s: v.number(),
});
export type Road = v.InferOutput<typeof Road>;

/**
 * Answers a hello: the client's epoch, the position of each stream, the study's tasks and texts.
 */
const Welcome = v.object({
  type: v.literal("welcome"),
  protocol: whole,
  session_id: v.string(),
  epoch: whole,
  time_scale: v.number(),
  language: v.string(),
  avatar: v.string(),
  on_disconnect: v.string(),
  undelayed_parts: v.array(v.string()),
  tasks: v.record(v.string(), v.unknown()),
  texts: v.record(v.string(), v.unknown()),
  positions: v.array(StreamPosition),
  state: HeadsetState,
  /** The bodies that the study's conditions prescribe; left out if there are none. */
  bodies: v.optional(v.array(v.string())),
  /** The palettes of the study's boxes, as in its file; a server of an older version has none. */
  appearance: v.optional(v.record(v.string(), v.unknown())),
  /** The sizes of the road that participants cross; left out if the study has none. */
  road: v.optional(Road),
});
export type Welcome = v.InferOutput<typeof Welcome>;

const Ack = v.object({ type: v.literal("ack"), positions: v.array(StreamPosition) });

/** A seq was skipped: resend from `next_seq`. */
const Resend = v.object({ type: v.literal("resend"), ...StreamPosition.entries });

/** Samples were stored as they came, and are flagged. */
const Flag = v.object({
  type: v.literal("flag"),
  code: v.picklist(["non_finite", "non_unit"]),
  stream: v.string(),
  epoch: whole,
  seq: whole,
  frames: whole,
  message: v.string(),
});
export type Flag = v.InferOutput<typeof Flag>;

/** A report was stored and does not count, because it did not fit the session's state. */
const RefusedReport = v.object({
  type: v.literal("refused"),
  epoch: whole,
  seq: whole,
  message: v.string(),
  remedy: v.string(),
});
export type RefusedReport = v.InferOutput<typeof RefusedReport>;

/** Why the server closes the connection. */
const Failure = v.object({
  type: v.literal("error"),
  code: v.string(),
  message: v.string(),
  remedy: v.string(),
});

/** The server's clock around a probe; its nanoseconds as the received digits. */
const Nanoseconds = v.pipe(v.string(), v.regex(/^\d{1,19}$/));
const ProbeAnswer = v.object({
  type: v.literal("probe"),
  client_sent_s: v.number(),
  server_received_ns: Nanoseconds,
  server_sent_ns: Nanoseconds,
});
export type ProbeAnswer = v.InferOutput<typeof ProbeAnswer>;

const SCHEMAS = {
  welcome: Welcome,
  state: HeadsetState,
  ack: Ack,
  resend: Resend,
  flag: Flag,
  refused: RefusedReport,
  error: Failure,
  probe: ProbeAnswer,
} as const;

type Schemas = typeof SCHEMAS;
export type ServerMessage = v.InferOutput<Schemas[keyof Schemas]>;

/**
 * The message in `text`; null if its type is unknown; throws MalformedMessage if a field is
 * missing.
 */
export function serverMessage(text: string): ServerMessage | null {
  const value = parsed(quoteNanoseconds(text));
  const type = narrowed(v.object({ type: v.string() }), value).type;
  if (!isKnown(type)) return null;
  return narrowed(SCHEMAS[type], value);
}

function parsed(text: string): unknown {
  try {
    return JSON.parse(text);
  } catch {
    throw new MalformedMessage(`not JSON: ${text.slice(0, 80)}`);
  }
}

const isKnown = (type: string): type is keyof Schemas => Object.hasOwn(SCHEMAS, type);

/**
 * Quote nanoseconds in the text: those since a machine's start exceed a double's precision after
 * 104 days.
 */
function quoteNanoseconds(text: string): string {
  if (!text.includes('"server_received_ns"')) return text;
  return text.replace(/("server_(?:received|sent)_ns"\s*:\s*)(\d+)/g, '$1"$2"');
}
