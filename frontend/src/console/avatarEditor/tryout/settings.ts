/** What is chosen in the try-out, and what it commands. Degrees and milliseconds, as people set them. */
import { AXES, PARTS } from "@shared/avatar/anatomy.generated";
import type { Command, Wave } from "./physics/commands";
import type { Shape } from "./physics/shapes";
import { DIRECTIONS, type Direction, scaled } from "./pulling";
import type { AvatarFile } from "./source";

const RADIANS = Math.PI / 180;

export interface DriveSettings {
  readonly kind: Wave["kind"];
  /** The held angle, or the centre of the wave. */
  readonly angleDeg: number;
  readonly amplitudeDeg: number;
  readonly periodS: number;
}

export interface PushSettings {
  readonly part: string;
  readonly direction: Direction;
  readonly forceN: number;
  readonly forS: number;
}

export const FIRST_PUSH: PushSettings = {
  part: "LeftLowerLeg",
  // At zero degrees the knee is at its lower limit: backwards it can bend.
  direction: "backward",
  forceN: 100,
  forS: 0.2,
};
/** Poses that a joint is driven in, degrees; what is not named is as in the T-pose. */
export const POSES = {
  t: {},
  leg: { LeftUpperLegX: 30, LeftLowerLegX: 50 },
  arms: { LeftUpperArmZ: -75, RightUpperArmZ: -75 },
} as const satisfies Readonly<Record<string, Readonly<Record<string, number>>>>;
export type PoseName = keyof typeof POSES;

export const poseCommand = (name: PoseName): Command => ({
  kind: "pose",
  anglesRad: Object.fromEntries(
    Object.entries(POSES[name]).map(([axis, angle]) => [axis, RADIANS * angle]),
  ),
});

export const FIRST_AXIS = "LeftUpperArmZ";
/** How far above a part a box begins to fall, metres. */
const FALL_M = 0.6;
export const AXIS_NAMES: readonly string[] = AXES.map(({ name }) => name);
export const PART_NAMES: readonly string[] = PARTS.map(({ name }) => name);
export const partOf = (axis: string): string =>
  AXES.find(({ name }) => name === axis)?.part ?? axis.slice(0, -1);

interface Limits {
  readonly lowDeg: number;
  readonly highDeg: number;
}

/** The limits between which an axis can be driven; those of an axis that is not there are zero. */
export function limitsOf(configuration: AvatarFile, axis: string): Limits {
  const own = configuration.axes[axis];
  return { lowDeg: own?.low_deg ?? 0, highDeg: own?.high_deg ?? 0 };
}

/** A first movement of an axis: at rest, with a wave within its limits at hand. */
export function firstDrive({ lowDeg, highDeg }: Limits): DriveSettings {
  return {
    kind: "hold",
    angleDeg: Math.min(Math.max(0, Math.ceil(lowDeg)), Math.floor(highDeg)),
    amplitudeDeg: Math.max(1, Math.min(20, Math.round((highDeg - lowDeg) / 4))),
    periodS: 2,
  };
}

/** A wave begins in the middle of the limits, where it has room in both directions. */
export const withKind = (
  drive: DriveSettings,
  kind: Wave["kind"],
  { lowDeg, highDeg }: Limits,
): DriveSettings => ({
  ...drive,
  kind,
  angleDeg:
    drive.kind === "hold" && kind !== "hold" ? Math.round((lowDeg + highDeg) / 2) : drive.angleDeg,
});

export function driveCommand(axis: string, drive: DriveSettings): Command {
  const { kind, periodS } = drive;
  const centerRad = RADIANS * drive.angleDeg;
  const wave: Wave =
    kind === "hold"
      ? { kind, angleRad: centerRad }
      : { kind, centerRad, amplitudeRad: RADIANS * drive.amplitudeDeg, periodS };
  return { kind: "drive", drive: { axis, wave } };
}

/** A push at a part's centre of mass. */
export function pushCommand(push: PushSettings): Command {
  const { part, direction, forceN, forS } = push;
  const force = scaled(DIRECTIONS[direction], forceN);
  return { kind: "push", push: { part, pointM: null, forceN: force, forS } };
}

/** Drop the box onto a part: `places` are those of the bodies of the model. */
export function dropCommand(part: string, shapes: readonly Shape[], places: Float32Array): Command {
  const body = shapes.find((one) => one.part === part)?.body ?? 0;
  const at = (i: number) => places[7 * body + i] as number;
  return { kind: "drop", centerM: [at(0), at(1) + FALL_M, at(2)] };
}
