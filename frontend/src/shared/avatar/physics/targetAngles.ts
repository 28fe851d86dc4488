/**
 * The avatar's target angles for the participant's poses, followed frame by frame.
 *
 * The server's `app/science/avatar/targets` explains the method (`targets.py`) and the equations
 * (`hinge_angles.py`); this is the same, operation by operation.
 */
import { AXES, FINGER_PARTS, JOINTS, PARTS } from "../anatomy.generated";
import { clamp, multiplyRows, roundHalfEven, TURN } from "./numbers";
import type { AxisLimits } from "./settings";

export const AXIS_COUNT = AXES.length;
const PART_COUNT = PARTS.length;
const PART_ROW = new Map<string, number>(PARTS.map(({ name }, row) => [name, row]));
const PARENT = new Map<string, string | null>(PARTS.map(({ name, parent }) => [name, parent]));
const AXIS_COLUMN = new Map<string, number>(AXES.map(({ name }, column) => [name, column]));
const JOINT_ROWS = JOINTS.map((name) => PART_ROW.get(name) as number);
const FINGER_ROWS = FINGER_PARTS.map((name) => PART_ROW.get(name) as number);
const LOCKED_COSINE = 1e-11;
/** How much further within the limits the other solution must lie to be chosen. */
const SWITCH_MARGIN_RAD = Math.PI / 4;
const FARTHEST_RAD = 1.25 * Math.PI;
const STRAIGHT_LIMB = 0.05;

type Row = readonly [number, number, number];

/** One driven part. */
interface Driven {
  /** Rows of the part itself and of the undriven parts between it and the next driven one above. */
  readonly folded: readonly number[];
  readonly column: number;
  readonly count: number;
  /** Its axes as columns, completed to three so that they are right-handed. */
  readonly frame: readonly [Row, Row, Row];
  /** 1 for a right-handed frame, -1 for a left-handed one. */
  readonly hand: number;
}

/** The bone above an elbow or knee and the part below, as indices of driven parts. */
interface Bend {
  readonly above: number;
  readonly below: number;
  readonly frame: readonly [Row, Row, Row];
}

export class TargetAngles {
  readonly lowRad = new Float64Array(AXIS_COUNT);
  readonly highRad = new Float64Array(AXIS_COUNT);
  /** The last frame's angles within the limits; zero for axes of absent parts. */
  readonly anglesRad = new Float64Array(AXIS_COUNT);
  readonly unclampedRad = new Float64Array(AXIS_COUNT);
  private readonly rest = new Float64Array(AXIS_COUNT);
  private readonly followed = new Float64Array(AXIS_COUNT);
  private readonly local = new Float64Array(4 * PART_COUNT);
  private readonly rows: Float64Array;
  private readonly driven: readonly Driven[];
  private readonly bends: readonly Bend[];
  private readonly wrists: readonly (readonly [number, number])[];
  private readonly inFrame = new Float64Array(4);
  private readonly turn = new Float64Array(4);
  private readonly solution = new Float64Array(3);
  private restart = true;

  constructor(limits: ReadonlyMap<string, AxisLimits>, parts: ReadonlySet<string>) {
    for (const [column, { name, part }] of AXES.entries()) {
      if (!parts.has(part)) continue;
      const own = limits.get(name);
      if (own === undefined) throw new Error(`The axis ${name} has no limits.`);
      this.lowRad[column] = own.lowRad;
      this.highRad[column] = own.highRad;
    }
    for (let column = 0; column < AXIS_COUNT; column++) {
      this.rest[column] = clamp(0, this.lowRad[column] as number, this.highRad[column] as number);
    }
    this.followed.set(this.rest);
    const names = PARTS.map(({ name }) => name as string).filter(
      (name) => parts.has(name) && axesOf(name).length > 0,
    );
    this.driven = names.map((name) => drivenPart(name, new Set(names)));
    this.rows = new Float64Array(4 * names.length);
    const turns = (axis: string) => {
      const column = AXIS_COLUMN.get(axis) as number;
      return this.lowRad[column] !== this.highRad[column];
    };
    this.bends = bendsOf(names, turns);
    this.wrists = ["Left", "Right"]
      .filter((side) => names.includes(`${side}Hand`) && names.includes(`${side}LowerArm`))
      .map((side) => [
        AXIS_COLUMN.get(`${side}HandX`) as number,
        AXIS_COLUMN.get(`${side}LowerArmX`) as number,
      ]);
    for (let row = 0; row < PART_COUNT; row++) this.local[4 * row] = 1;
  }

  /** Forget the previous frames: the next one is followed from the rest angles. */
  forget(): void {
    this.restart = true;
  }

  /**
   * Compute `anglesRad` and `unclampedRad` of a frame.
   *
   * `rotations`: 22 local rotations from `at` on; `fingers`: 30 from `fingersAt` on, null at rest.
   * Where one is not finite, neither are the angles that depend on it.
   */
  follow(
    rotations: Float64Array,
    at: number,
    fingers: Float64Array | null,
    fingersAt = 0,
  ): Float64Array {
    copyRows(rotations, at, JOINT_ROWS, this.local);
    if (fingers === null) restRows(FINGER_ROWS, this.local);
    else copyRows(fingers, fingersAt, FINGER_ROWS, this.local);
    let margin = SWITCH_MARGIN_RAD;
    if (this.restart) {
      this.followed.set(this.rest);
      margin = 0;
    }
    this.unclampedRad.set(this.rest);
    this.multiplyUndriven();
    this.turnBendPlanes();
    this.fit(margin);
    const { unclampedRad, anglesRad, followed, lowRad, highRad } = this;
    for (let column = 0; column < AXIS_COUNT; column++) {
      const angle = unclampedRad[column] as number;
      if (Number.isFinite(angle)) followed[column] = angle;
    }
    this.moveWristExcess();
    for (let column = 0; column < AXIS_COUNT; column++) {
      anglesRad[column] = clamp(
        unclampedRad[column] as number,
        lowRad[column] as number,
        highRad[column] as number,
      );
    }
    this.restart = false;
    return anglesRad;
  }

  /** Multiply each driven part's rotation by those of the undriven parts above it. */
  private multiplyUndriven(): void {
    const { rows, local, driven } = this;
    for (let part = 0; part < driven.length; part++) {
      const { folded } = driven[part] as Driven;
      const own = 4 * (folded[0] as number);
      for (let i = 0; i < 4; i++) rows[4 * part + i] = local[own + i] as number;
      for (let k = 1; k < folded.length; k++) {
        multiplyRows(local, 4 * (folded[k] as number), rows, 4 * part, rows, 4 * part);
      }
    }
  }

  /** Turn the bone above each elbow and knee about its own axis until the hinge fits the bend. */
  private turnBendPlanes(): void {
    const { rows, inFrame, turn } = this;
    for (let k = 0; k < this.bends.length; k++) {
      const { above, below, frame } = this.bends[k] as Bend;
      toFrame(rows, 4 * below, frame, 1, inFrame);
      const w = inFrame[0] as number;
      const x = inFrame[1] as number;
      const y = inFrame[2] as number;
      const z = inFrame[3] as number;
      const length = Math.max(Math.hypot(w, z), 1e-12);
      const half =
        Math.atan2((y * w + x * z) / length, (x * w - y * z) / length + STRAIGHT_LIMB) / 2;
      const s = Math.sin(half);
      turn[0] = Math.cos(half);
      for (let i = 0; i < 3; i++) turn[i + 1] = s * ((frame[i] as Row)[2] as number);
      multiplyRows(rows, 4 * above, turn, 0, rows, 4 * above);
      for (let i = 1; i < 4; i++) turn[i] = -(turn[i] as number);
      multiplyRows(turn, 0, rows, 4 * below, rows, 4 * below);
    }
  }

  /** Write each part's angles from its first column on. */
  private fit(margin: number): void {
    const { rows, driven, inFrame, followed, unclampedRad, lowRad, highRad } = this;
    for (let part = 0; part < driven.length; part++) {
      const { column: at, count, frame, hand } = driven[part] as Driven;
      toFrame(rows, 4 * part, frame, hand, inFrame);
      const w = inFrame[0] as number;
      const x = inFrame[1] as number;
      const y = inFrame[2] as number;
      const z = inFrame[3] as number;
      const middle = ((lowRad[at] as number) + (highRad[at] as number)) / 2;
      if (!Number.isFinite(w + x + y + z)) {
        unclampedRad.fill(Number.NaN, at, at + count);
      } else if (count === 3) {
        this.three(hand * (followed[at] as number), hand * (followed[at + 2] as number));
        this.choose(hand, at, margin);
      } else if (count === 2) {
        const total = Math.atan2(x + y, w - z);
        const difference = Math.atan2(x - y, w + z);
        const second = ((lowRad[at + 1] as number) + (highRad[at + 1] as number)) / 2;
        unclampedRad[at] = unwrapped(total + difference, followed[at] as number, middle);
        unclampedRad[at + 1] = unwrapped(total - difference, followed[at + 1] as number, second);
      } else {
        unclampedRad[at] = unwrapped(2 * Math.atan2(x, w), followed[at] as number, middle);
      }
    }
  }

  /** Write one of the two solutions for a part with three axes to `solution`. */
  private three(previousFirst: number, previousThird: number): void {
    const { inFrame, solution } = this;
    const w = inFrame[0] as number;
    const x = inFrame[1] as number;
    const y = inFrame[2] as number;
    const z = inFrame[3] as number;
    const r13 = 2 * (x * z + w * y);
    const r23 = 2 * (y * z - w * x);
    const r33 = 1 - 2 * (x * x + y * y);
    const r21 = 2 * (x * y + w * z);
    const r22 = 1 - 2 * (x * x + z * z);
    const r31 = 2 * (x * z - w * y);
    const r32 = 2 * (y * z + w * x);
    let a = Math.atan2(-r23, r33);
    if (Math.hypot(r23, r33) < LOCKED_COSINE) {
      const side = r13 > 0 ? 1 : -1;
      const change = Math.atan2(r21, r22) - (previousThird + side * previousFirst);
      a = previousFirst + (side * (change - TURN * roundHalfEven(change / TURN))) / 2;
    }
    const cosine = Math.cos(a);
    const sine = Math.sin(a);
    solution[0] = a;
    solution[1] = Math.atan2(r13, cosine * r33 - sine * r23);
    solution[2] = Math.atan2(cosine * r21 + sine * r31, cosine * r22 + sine * r32);
  }

  /** Write the solution nearer to the previous angles, or the one that fits the limits better. */
  private choose(hand: number, at: number, margin: number): void {
    const { solution, followed, lowRad, highRad, unclampedRad } = this;
    let beyond = 0;
    let far = 0;
    for (let k = 0; k < 3; k++) {
      const low = lowRad[at + k] as number;
      const high = highRad[at + k] as number;
      const previous = followed[at + k] as number;
      const own = solution[k] as number;
      const other = k === 1 ? Math.PI - own : own + Math.PI;
      const p = unwrapped(hand * own, previous, (low + high) / 2);
      const q = unwrapped(hand * other, previous, (low + high) / 2);
      unclampedRad[at + k] = q;
      beyond += Math.max(low - p, p - high, 0) - Math.max(low - q, q - high, 0);
      far += Math.abs(p - previous) - Math.abs(q - previous);
    }
    if (Math.abs(beyond) > margin ? beyond >= 0 : far > 0) return;
    for (let k = 0; k < 3; k++) {
      const middle = ((lowRad[at + k] as number) + (highRad[at + k] as number)) / 2;
      const own = hand * (solution[k] as number);
      unclampedRad[at + k] = unwrapped(own, followed[at + k] as number, middle);
    }
  }

  /** Move the wrist's turn beyond its limits to the forearm, which has the same axis. */
  private moveWristExcess(): void {
    const { unclampedRad, lowRad, highRad } = this;
    for (let k = 0; k < this.wrists.length; k++) {
      const [wrist, forearm] = this.wrists[k] as readonly [number, number];
      const angle = unclampedRad[wrist] as number;
      const clamped = clamp(angle, lowRad[wrist] as number, highRad[wrist] as number);
      unclampedRad[forearm] = (unclampedRad[forearm] as number) + (angle - clamped);
      unclampedRad[wrist] = clamped;
    }
  }
}

/** Add whole turns so that the angle is near the previous one, or near the middle of its range. */
function unwrapped(angle: number, previous: number, middle: number): number {
  const near = angle + TURN * roundHalfEven((previous - angle) / TURN);
  if (Math.abs(near - middle) <= FARTHEST_RAD) return near;
  return near + TURN * roundHalfEven((middle - near) / TURN);
}

/** The rotation in the frame of the columns of `frame`; `hand` is its handedness. */
function toFrame(
  rows: Float64Array,
  at: number,
  frame: readonly [Row, Row, Row],
  hand: number,
  result: Float64Array,
): void {
  const x = rows[at + 1] as number;
  const y = rows[at + 2] as number;
  const z = rows[at + 3] as number;
  result[0] = rows[at] as number;
  for (let i = 0; i < 3; i++) {
    result[i + 1] =
      hand *
      ((frame[0][i] as number) * x + (frame[1][i] as number) * y + (frame[2][i] as number) * z);
  }
}

function copyRows(
  from: Float64Array,
  at: number,
  rows: readonly number[],
  into: Float64Array,
): void {
  for (let index = 0; index < rows.length; index++) {
    const row = 4 * (rows[index] as number);
    for (let i = 0; i < 4; i++) into[row + i] = from[at + 4 * index + i] as number;
  }
}

function restRows(rows: readonly number[], into: Float64Array): void {
  for (let index = 0; index < rows.length; index++) {
    const row = 4 * (rows[index] as number);
    into[row] = 1;
    into.fill(0, row + 1, row + 4);
  }
}

const axesOf = (part: string) => AXES.filter((axis) => axis.part === part);

function drivenPart(part: string, driven: ReadonlySet<string>): Driven {
  const axes = axesOf(part);
  const folded = [PART_ROW.get(part) as number];
  let above = PARENT.get(part) ?? null;
  while (above !== null && above !== "Hips" && !driven.has(above)) {
    folded.push(PART_ROW.get(above) as number);
    above = PARENT.get(above) ?? null;
  }
  const columns: Row[] = axes.map(({ direction }) => direction as Row);
  const first = columns[0] as Row;
  // As in the server: a second axis by rolling the first, a third by their cross product.
  if (columns.length === 1) columns.push([first[2], first[0], first[1]]);
  if (columns.length === 2) columns.push(crossed(columns[0] as Row, columns[1] as Row));
  const [a, b, c] = columns as [Row, Row, Row];
  return {
    folded,
    column: AXIS_COLUMN.get(axes[0]?.name as string) as number,
    count: axes.length,
    frame: transposed(a, b, c),
    hand: Math.round(dotted(crossed(a, b), c)),
  };
}

/** Part above, hinge, letters of the axes of the hinge's bend and of the bone itself. */
const BENDS = [
  ["UpperArm", "LowerArm", "Y", "X"],
  ["UpperLeg", "LowerLeg", "X", "Y"],
] as const;

function bendsOf(names: readonly string[], turns: (axis: string) => boolean): readonly Bend[] {
  return ["Left", "Right"].flatMap((side) =>
    BENDS.flatMap(([upper, hinge, bend, bone]) => {
      const above = names.indexOf(`${side}${upper}`);
      const below = names.indexOf(`${side}${hinge}`);
      // An elbow that turns about its third axis can bend in any plane.
      const isFree = hinge === "LowerArm" && turns(`${side}LowerArmZ`);
      if (above < 0 || below < 0 || isFree) return [];
      const along = (letter: string) =>
        axesOf(`${side}${hinge}`).find((axis) => axis.letter === letter)?.direction as Row;
      const [a, c] = [along(bend), along(bone)];
      return [{ above, below, frame: transposed(a, crossed(c, a), c) }];
    }),
  );
}

const dotted = (a: Row, b: Row): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const crossed = (a: Row, b: Row): Row => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0],
];
/** The rows of the matrix with these columns. */
const transposed = (a: Row, b: Row, c: Row): [Row, Row, Row] => [
  [a[0], b[0], c[0]],
  [a[1], b[1], c[1]],
  [a[2], b[2], c[2]],
];
