/**
 * A scripted person who is calibrated, step by step as the prompts ask, for tests and benchmarks.
 *
 * People differ as real ones do: stature, span, the eyes' share of the stature, and where their
 * devices sit. What a person is asked for is done within a second; who stands with bent knees, or
 * wears devices on the wrong sides, does so until told.
 */
import type { Place } from "@shared/avatar/hips";
import { multiply, plus, type Quaternion, type Vector } from "@shared/rotations";
import { type Calibration, CalibrationRun, Calibrator, type Measures } from "../calibration";
import type { CalibrationPrompt } from "../calibration/steps";
import { AT_ORIGIN, composed, inverted } from "../tracking/places";
import { ScriptedPerson, ScriptSource, type WornDevices } from "../tracking/script";
import { type Random, seeded } from "../tracking/script/random";
import type { GoalPart, TrackedFrame, TrackingDevice } from "../tracking/tracked";
import { EYES_AT, usualOffsets, type WornOffsets } from "../tracking/worn";
import { PromptedPerson } from "./promptedPerson";

export type Wears = "controllers" | "hands" | "shins" | "body";

export interface CalibratedPerson {
  readonly statureM: number;
  readonly spanM: number;
  readonly seed: number;
  readonly wears: Wears;
  /** Height of the eyes; by default the product's share of the stature. */
  readonly eyeHeightM?: number;
  /** Standard deviation of every device's position per axis, and of its tilt. */
  readonly noiseM?: number;
  readonly noiseRad?: number;
  /** How differently from the usual the devices are worn; 0: exactly as usual. */
  readonly differing?: number;
  readonly restlessness?: number;
  readonly swapped?: "hands" | "shins" | null;
  /** Whether somebody who is told so gives the controllers to the other hands. */
  readonly swapsBack?: boolean;
  /** The steps in which the person bends the knees by so much of a squat, until told. */
  readonly bends?: { readonly during: readonly CalibrationPrompt["step"][]; readonly by: number };
  readonly statedStatureM?: number | null;
  /** Where the start square lies in the room. */
  readonly roomFromWorld?: Place;
}

/** Inverse kinematics of a body with these lengths: the distance left of every goal. */
export type MakeBody = (measures: Measures) => {
  errorsOf(goals: ReturnType<Calibrator["goals"]>): ArrayLike<number>;
  dispose(): void;
};

export interface CalibratedOutcome {
  readonly calibration: Calibration;
  /** What was asked for, in order, without repetitions: "n_pose", "n_pose bent_knees", ... */
  readonly asked: readonly string[];
  readonly tookS: number;
  /** Where each part's joint is in the frame of what tracks it: what calibration has to find. */
  readonly trackerFromGoal: WornOffsets;
  /** Whether the poses were made more than once. */
  readonly wasRepeated: boolean;
}

const RATE_HZ = 90;
const LONGEST_S = 180;
const SHINS: readonly GoalPart[] = ["LeftLowerLeg", "RightLowerLeg"];
const HANDS: readonly GoalPart[] = ["LeftHand", "RightHand"];
const DEGREES = Math.PI / 180;

/** Calibrate a person. Throws if it does not end within three minutes of the person's time. */
export function calibrate(wish: CalibratedPerson, makeBody: MakeBody | null): CalibratedOutcome {
  const { statureM, spanM, seed, restlessness = 1 } = wish;
  const person = new ScriptedPerson({ statureM, spanM, seed, restlessness });
  const offsets = wornBy(wish);
  const { swapped = null, noiseM = 0, noiseRad = 0 } = wish;
  let source = sourceOf(wish, person, { offsets, swapped, noiseM, noiseRad, seed });
  const run = new CalibrationRun({
    statedStatureM: wish.statedStatureM ?? null,
    bodyStatureM: null,
    movesSquare: true,
  });
  const calibrator = new Calibrator();
  let body: ReturnType<MakeBody> | null = null;
  let room = wish.roomFromWorld ?? AT_ORIGIN;
  const asked: string[] = [];
  let madeFor: number | null = null;
  let errors: ArrayLike<number> | null = null;
  let wasRepeated = false;
  let timeS = 0;
  const prompted = new PromptedPerson(person);
  try {
    while (!run.isDone) {
      timeS += 1 / RATE_HZ;
      if (timeS > LONGEST_S) throw new Error(`no calibration: ${asked.join(", ")}`);
      const { prompt } = run;
      if (prompt !== null) {
        const text =
          prompt.problem === null ? prompt.step : `${prompt.step} ${prompt.problem.kind}`;
        if (asked.at(-1) !== text) asked.push(text);
        wasRepeated ||= prompt.again !== null;
        const { bends } = wish;
        const wasTold = asked.some((one) => one.endsWith("bent_knees")) || wasRepeated;
        const isBent = bends !== undefined && !wasTold && bends.during.includes(prompt.step);
        prompted.follow(prompt.step, timeS, isBent ? bends.by : 0);
      }
      if (wish.swapsBack === true && asked.some((one) => one.endsWith("swapped_hands"))) {
        source = sourceOf(wish, person, { offsets, swapped: null, noiseM, noiseRad, seed });
      }
      const tracked = inRoom(source.read(timeS), room);
      run.frame(tracked, { kind: source.kind, measures: source.measures }, errors);
      const square = run.takeSquare();
      // The source reports in the square's frame from then on.
      if (square !== null) room = composed(inverted(square), room);
      const { calibration } = run;
      if (calibration !== null && calibration !== calibrator.calibration) {
        calibrator.use(calibration);
        if (makeBody !== null && calibration.eyeHeightM !== madeFor) {
          body?.dispose();
          body = makeBody(calibration);
          madeFor = calibration.eyeHeightM;
        }
      }
      errors = body?.errorsOf(calibrator.goals(tracked)) ?? (makeBody === null ? NO_ERRORS : null);
    }
  } finally {
    body?.dispose();
  }
  const found = run.calibration as Calibration;
  return {
    calibration: found,
    asked,
    tookS: timeS,
    trackerFromGoal: inverses(offsets),
    wasRepeated,
  };
}

const NO_ERRORS = new Float64Array(6);

function sourceOf(
  { wears }: CalibratedPerson,
  person: ScriptedPerson,
  worn: ConstructorParameters<typeof WornDevices>[1],
): ScriptSource {
  const devices: Partial<Record<GoalPart, TrackingDevice>> = {};
  if (wears === "hands") for (const hand of HANDS) devices[hand] = "hand";
  if (wears === "body")
    for (const part of [...HANDS, ...SHINS, "Hips"] as const) devices[part] = "body";
  return new ScriptSource(person, {
    worn: worn ?? {},
    hasShins: wears === "shins" || wears === "body",
    hasWaist: wears === "body",
    devices,
  });
}

/** Where this person's devices sit: as is usual, but for the differences of people and straps. */
function wornBy(wish: CalibratedPerson): WornOffsets {
  const { statureM, eyeHeightM = EYES_AT * statureM, differing = 0, wears, seed } = wish;
  const random = seeded(seed + 1000);
  const usual = usualOffsets(statureM);
  const [, up] = usual.Head.positionM;
  const eyes: Vector = [0, up + eyeHeightM - EYES_AT * statureM, usual.Head.positionM[2]];
  const differ = (place: Place, m: number, rad: number): Place =>
    differing === 0 ? place : moved(place, differing * m, differing * rad, random);
  // The browser's body tracking knows joints, turned as their maker's model is.
  const joint = () => moved(AT_ORIGIN, 0.005, 40 * DEGREES, random);
  const isBody = wears === "body";
  const strapped = (part: GoalPart) => (isBody ? joint() : differ(usual[part], 0.02, 15 * DEGREES));
  const hand = (part: GoalPart) => {
    if (isBody) return joint();
    return wears === "hands" ? AT_ORIGIN : differ(usual[part], 0.005, 5 * DEGREES);
  };
  return {
    Hips: strapped("Hips"),
    Head: { positionM: eyes, rotation: usual.Head.rotation },
    LeftHand: hand("LeftHand"),
    RightHand: hand("RightHand"),
    LeftLowerLeg: strapped("LeftLowerLeg"),
    RightLowerLeg: strapped("RightLowerLeg"),
  };
}

function moved({ positionM, rotation }: Place, m: number, rad: number, random: Random): Place {
  const drawn = (size: number): Vector => [
    size * random.normal(),
    size * random.normal(),
    size * random.normal(),
  ];
  const [x, y, z] = drawn(rad / 2);
  const size = Math.sqrt(1 + x * x + y * y + z * z);
  const turn: Quaternion = [1 / size, x / size, y / size, z / size];
  return { positionM: plus(positionM, drawn(m)), rotation: multiply(rotation, turn) };
}

const inverses = (offsets: WornOffsets): WornOffsets =>
  Object.fromEntries(
    Object.entries(offsets).map(([part, place]) => [part, inverted(place)]),
  ) as WornOffsets;

/** The frame as a device reports it whose floor has its origin elsewhere. */
function inRoom(frame: TrackedFrame, room: Place): TrackedFrame {
  if (room === AT_ORIGIN) return frame;
  const place = (one: Place | null) => (one === null ? null : composed(room, one));
  const parts = Object.fromEntries(
    Object.entries(frame.parts).map(([part, one]) => [part, { ...one, place: place(one.place) }]),
  ) as TrackedFrame["parts"];
  return { ...frame, eyes: place(frame.eyes), parts };
}
