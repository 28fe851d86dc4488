/** Requests for the replay of a phase: its events and its movement. */
import { MotionError, type PointMotion, splitMovement } from "../stage/motion";
import { accountHeader, answer, errorFromBody, server, Unreachable } from "./request";
import type { components } from "./schema";

type Schemas = components["schemas"];
export type Replay = Schemas["Replay"];
export type ReplayContact = Schemas["ReplayContact"];
export type ReplaySurface = Schemas["ReplaySurface"];
export type ReplayMoment = Schemas["Moment"];

/** An interval of the phase's time, seconds. */
export type Span = readonly [begin: number, end: number];

/** The movement recorded in a phase, without the avatar for blinded readers. */
export interface ReplayMovement {
  readonly participant: PointMotion;
  readonly avatar: PointMotion | null;
  /** Intervals in which nothing was recorded. */
  readonly gaps: readonly Span[];
  readonly errors: JointErrors;
}

/** Angles between the avatar's target and actual joint rotations, radians, [frame][joint]. */
export interface JointErrors {
  readonly joints: readonly string[];
  readonly frames: number;
  readonly rateHz: number;
  readonly values: Float32Array;
}

interface Header {
  readonly names: readonly string[];
  readonly parents: readonly number[];
  readonly bodies: readonly string[];
  readonly frames: number;
  readonly rate_hz: number;
  readonly error_joints: readonly string[];
  readonly error_frames: number;
  readonly error_rate_hz: number;
  readonly gaps: readonly Span[];
  readonly rotations?: boolean;
  readonly finger_parts?: readonly string[];
}

export const replays = {
  get: (id: string, phase: number) =>
    answer<Replay>(
      server.GET("/api/sessions/{session_id}/phases/{phase_id}/replay", {
        params: { path: { session_id: id, phase_id: phase } },
      }),
    ),
  /** With `rotations` also those of the joints, which a body with skin is drawn by. */
  movement: async (id: string, phase: number, rotations: boolean): Promise<ReplayMovement> => {
    const query = rotations ? "?rotations=true" : "";
    const url = `/api/sessions/${encodeURIComponent(id)}/phases/${phase}/movement${query}`;
    const response = await fetch(url, {
      credentials: "same-origin",
      headers: accountHeader(),
    }).catch((cause: unknown) => {
      throw new Unreachable("The server cannot be reached.", { cause });
    });
    if (!response.ok) throw errorFromBody(response.status, await response.json().catch(() => null));
    return decodeMovement(await response.arrayBuffer());
  },
};

const numbersOfBody = ({ frames, names }: Header): number => frames * names.length * 3;

const countOf = (header: Header): number =>
  header.bodies.length * numbersOfBody(header) + header.error_frames * header.error_joints.length;

const rotationsOfBody = ({ frames, names, rotations }: Header): number =>
  rotations === true ? 4 * frames * names.length : 0;

const fingersOfBody = ({ frames, finger_parts: parts = [] }: Header): number =>
  4 * frames * parts.length;

/**
 * Decode the server's format: the header's length, the header as JSON, then as little-endian
 * float32 the positions of each body, followed by the joint errors, then as integers of 16 bits the
 * rotations of each body, and of each body's fingers, if there are any.
 *
 * Throws MotionError if the bytes do not match the header.
 */
export function decodeMovement(bytes: ArrayBuffer): ReplayMovement {
  const integersOf = (header: Header) =>
    header.bodies.length * (rotationsOfBody(header) + fingersOfBody(header));
  const { header, numbers: all, integers } = splitMovement(bytes, countOf, integersOf);
  const ofBody = numbersOfBody(header);
  const body = (name: string): PointMotion | null => {
    const at = header.bodies.indexOf(name);
    if (at < 0) return null;
    const positions = all.subarray(at * ofBody, (at + 1) * ofBody);
    const { names, parents, frames, rate_hz: rateHz } = header;
    const turned = rotationsOfBody(header);
    const bent = fingersOfBody(header);
    const fingersAt = header.bodies.length * turned + at * bent;
    return {
      ...({ kind: "skeleton", names, parents, frames, rateHz } as const),
      recordedRateHz: rateHz,
      positions,
      ...(turned > 0 ? { rotations: integers.subarray(at * turned, (at + 1) * turned) } : {}),
      ...(bent > 0 ? { fingers: integers.subarray(fingersAt, fingersAt + bent) } : {}),
    };
  };
  const participant = body("target");
  if (participant === null) throw new MotionError("The participant is missing.");
  return {
    participant,
    avatar: body("actual"),
    gaps: header.gaps,
    errors: {
      joints: header.error_joints,
      frames: header.error_frames,
      rateHz: header.error_rate_hz,
      values: all.subarray(header.bodies.length * ofBody),
    },
  };
}
