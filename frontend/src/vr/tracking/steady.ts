/**
 * Goals without jumps: what inverse kinematics is asked for while devices are lost, come back, or
 * are exchanged for others.
 *
 * - A part that is lost stays where it was for a second: a hand beside the head that it belongs to,
 *   a shin on its spot. Then it has no goal. Its state says `lost` at once.
 * - When it returns, or another device takes it over, or the room was recentred, the difference
 *   between where it was shown and where it is now fades within 0.3 s along a minimum-jerk course; it
 *   moves with the device meanwhile, so nothing lags behind.
 *
 * It works on joints, after calibration, since different devices sit at different offsets.
 */
import { GOAL_PARTS, type Goals, NO_GOALS } from "@shared/avatar/goals";
import type { Place } from "@shared/avatar/hips";
import {
  minus,
  multiply,
  normalised,
  plus,
  type Quaternion,
  times,
  type Vector,
} from "@shared/rotations";
import { blendedRotation, composed, conjugate, headingOf, inverted, onFloor } from "./places";
import type { GoalPart, TrackedFrame, TrackedPart, TrackingDevice } from "./tracked";

const HOLD_S = 1;
const FADE_S = 0.3;
const IDENTITY: Quaternion = [1, 0, 0, 0];

interface Memory {
  /** Where the joint was shown last; null before it was seen, or long after it was lost. */
  shown: Place | null;
  /** The head that a hand was last seen beside, and where the hand was then. */
  besideHead: Place | null;
  seen: Place | null;
  device: TrackingDevice | null;
  lostSinceS: number | null;
  fadeFromS: number;
  offM: Vector;
  off: Quaternion;
}

const HANDS: ReadonlySet<GoalPart> = new Set(["LeftHand", "RightHand"]);

const memory = (): Memory => ({
  shown: null,
  besideHead: null,
  seen: null,
  device: null,
  lostSinceS: null,
  fadeFromS: Number.NEGATIVE_INFINITY,
  offM: [0, 0, 0],
  off: IDENTITY,
});

export class SteadyGoals {
  private readonly memories = Object.fromEntries(
    GOAL_PARTS.map((part) => [part, memory()]),
  ) as Record<GoalPart, Memory>;
  private readonly goals: Record<GoalPart, Place | null> = { ...NO_GOALS };
  private isRestarted = false;

  /** Fade from what was shown to what is shown next, such as after a calibration or a recentring. */
  restart(): void {
    this.isRestarted = true;
  }

  /** The goals of this frame; `given` are those of the calibration. Valid until the next call. */
  steady({ timeS, parts }: TrackedFrame, given: Goals): Goals {
    const head = given.Head ?? this.memories.Head.shown;
    for (const part of GOAL_PARTS) {
      const one = this.memories[part];
      const goal = given[part];
      const next = this.next(one, part, goal, parts[part], head, timeS);
      this.goals[part] = next;
      one.shown = next;
      if (HANDS.has(part) && next !== null && goal !== null && head !== null) {
        one.besideHead = head;
        one.seen = next;
      }
    }
    this.isRestarted = false;
    return this.goals;
  }

  private next(
    one: Memory,
    part: GoalPart,
    goal: Place | null,
    { state, device }: TrackedPart,
    head: Place | null,
    timeS: number,
  ): Place | null {
    if (state === "lost") return this.held(one, part, head, timeS);
    // Inferred by inverse kinematics itself, which starts from where the hips are.
    return goal === null ? null : this.faded(one, goal, device, timeS);
  }

  private held(one: Memory, part: GoalPart, head: Place | null, timeS: number): Place | null {
    one.lostSinceS ??= timeS;
    if (timeS - one.lostSinceS > HOLD_S) return null;
    if (HANDS.has(part) && one.besideHead !== null && one.seen !== null && head !== null) {
      const headFromHand = composed(inverted(levelled(one.besideHead)), one.seen);
      return composed(levelled(head), headFromHand);
    }
    return one.shown;
  }

  private faded(one: Memory, goal: Place, device: TrackingDevice | null, timeS: number): Place {
    const isNew = one.lostSinceS !== null || one.device !== device || this.isRestarted;
    one.lostSinceS = null;
    one.device = device;
    if (isNew && one.shown !== null) {
      one.fadeFromS = timeS;
      one.offM = minus(one.shown.positionM, goal.positionM);
      one.off = normalised(multiply(one.shown.rotation, conjugate(goal.rotation)));
    }
    const progress = (timeS - one.fadeFromS) / FADE_S;
    if (progress >= 1) return goal;
    const left = 1 - progress ** 3 * (10 + progress * (6 * progress - 15));
    return {
      positionM: plus(goal.positionM, times(one.offM, left)),
      rotation: normalised(multiply(blendedRotation(IDENTITY, one.off, left), goal.rotation)),
    };
  }
}

/** The head's place without its nodding: a hand that is lost does not nod with it. */
function levelled(head: Place): Place {
  const [x, y, z] = head.positionM;
  const level = onFloor(x, z, headingOf(head));
  return { positionM: [x, y, z], rotation: level.rotation };
}
