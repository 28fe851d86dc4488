/**
 * Turn the targets of a limb's parts so that each returns to its own direction in the world.
 *
 * The server's `app/science/avatar/targets/limb_yield.py` explains the rule: with d the filtered
 * rotation vector by which the part above deviates from its target, the target angle of an axis of
 * direction e becomes q - e . d.
 */
import { AXES } from "../anatomy.generated";
import { inverseMultiplyRows, multiplyRows } from "./numbers";

const YIELD_S = 0.1;
const TINY = 1e-12;
const PARTS: Readonly<Record<string, readonly string[]>> = {
  arm: ["UpperArm", "LowerArm", "Hand"],
  leg: ["UpperLeg", "LowerLeg", "Foot", "Toes"],
};

interface Axis {
  readonly column: number;
  readonly direction: readonly number[];
}
interface Limb {
  /** The axes of each part, from the body outwards. */
  readonly parts: readonly (readonly Axis[])[];
  /** The deviation of each part but the last, as a rotation vector in its own frame. */
  readonly deviations: readonly Float64Array[];
}

export class LimbYield {
  private readonly limbs: readonly Limb[];
  private readonly turned = new Float64Array(AXES.length);
  private readonly turn = new Float64Array(4);
  private readonly about = new Float64Array(4);
  private readonly wanted = new Float64Array(4);
  private readonly found = new Float64Array(4);
  private readonly now = new Float64Array(4);
  private readonly vector = new Float64Array(3);

  /** `limbs`: those with world targets, such as `left_leg`. */
  constructor(limbs: readonly string[]) {
    this.limbs = limbs.map((limb) => {
      const parts = partsOf(limb).map(axesOf);
      return { parts, deviations: parts.slice(1).map(() => new Float64Array(3)) };
    });
  }

  /** Forget all deviations: the body was put into a pose. */
  forget(): void {
    for (const { deviations } of this.limbs) for (const one of deviations) one.fill(0);
  }

  /** The angles to command: the targets, turned against the deviations; kept until the next call. */
  commands(targets: Float64Array): Float64Array {
    const { turned, turn } = this;
    turned.set(targets);
    for (const { parts, deviations } of this.limbs) {
      deviations.forEach((deviation, row) => {
        identity(turn);
        for (const { column, direction } of parts[row + 1] ?? []) {
          rotate(turn, direction, this.vector);
          let along = 0;
          for (let i = 0; i < 3; i++) along += at(this.vector, i) * at(deviation, i);
          turned[column] = at(turned, column) - along;
          this.append(turn, direction, at(targets, column));
        }
      });
    }
    return turned;
  }

  /** Let the deviations follow the actual angles, which are NaN where there is no hinge. */
  note(targets: Float64Array, actual: Float64Array, elapsedS: number): void {
    const share = 1 - Math.exp(-elapsedS / YIELD_S);
    for (const { parts, deviations } of this.limbs) {
      identity(this.wanted);
      identity(this.found);
      deviations.forEach((deviation, row) => {
        for (const { column, direction } of parts[row] ?? []) {
          const target = at(targets, column);
          const angle = at(actual, column);
          this.append(this.wanted, direction, target);
          this.append(this.found, direction, Number.isNaN(angle) ? target : angle);
        }
        inverseMultiplyRows(this.wanted, 0, this.found, 0, this.now, 0);
        rotationVector(this.now, this.vector);
        for (let i = 0; i < 3; i++) {
          deviation[i] = at(deviation, i) + share * (at(this.vector, i) - at(deviation, i));
        }
      });
    }
  }

  /** Multiply a rotation by a turn about an axis. */
  private append(into: Float64Array, direction: readonly number[], angle: number): void {
    const s = Math.sin(angle / 2);
    this.about[0] = Math.cos(angle / 2);
    for (let i = 0; i < 3; i++) this.about[i + 1] = s * (direction[i] as number);
    multiplyRows(into, 0, this.about, 0, into, 0);
  }
}

const at = (values: Float64Array, index: number): number => values[index] as number;

function partsOf(limb: string): readonly string[] {
  const [side = "", kind = ""] = limb.split("_");
  const name = side.charAt(0).toUpperCase() + side.slice(1);
  return (PARTS[kind] ?? []).map((part) => name + part);
}

function axesOf(name: string): readonly Axis[] {
  return AXES.flatMap(({ part, direction }, column) =>
    part === name ? [{ column, direction }] : [],
  );
}

function identity(q: Float64Array): void {
  q.fill(0);
  q[0] = 1;
}

/** Write the direction turned by a rotation: v + 2 w (u x v) + 2 u x (u x v). */
function rotate(q: Float64Array, direction: readonly number[], into: Float64Array): void {
  const [x = 0, y = 0, z = 0] = direction;
  const [w, a, b, c] = [at(q, 0), at(q, 1), at(q, 2), at(q, 3)];
  const [p, r, s] = [2 * (b * z - c * y), 2 * (c * x - a * z), 2 * (a * y - b * x)];
  into[0] = x + w * p + (b * s - c * r);
  into[1] = y + w * r + (c * p - a * s);
  into[2] = z + w * s + (a * r - b * p);
}

/** Write the rotation vector of a unit quaternion, the shorter way round. */
function rotationVector(q: Float64Array, into: Float64Array): void {
  const length = Math.hypot(at(q, 1), at(q, 2), at(q, 3));
  const sign = at(q, 0) < 0 ? -1 : 1;
  const factor = length < TINY ? 0 : (2 * Math.atan2(length, Math.abs(at(q, 0))) * sign) / length;
  for (let i = 0; i < 3; i++) into[i] = factor * at(q, i + 1);
}
