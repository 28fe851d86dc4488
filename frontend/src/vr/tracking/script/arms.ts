/**
 * What a scripted person does with a hand: hang, hold a pose, reach into boxes, point at panels. The
 * reaching is that of the server's `app/science/simulation/hands.py`.
 */
import { length, plus, times, type Vector } from "@shared/rotations";
import {
  type Aim,
  aimedPath,
  minimumJerk,
  type ScriptedGoal,
  type SmoothPath,
  unit,
} from "./movements";
import type { Random } from "./random";

const ENGAGE_S = 0.45;
const BACK_OFF_M = 0.08;
/** Share of the way out after which hand and wrist are past the edges. */
const OUT_SHARE = 0.6;
const FORWARD: Vector = [0, 0, -1];
const TURN_RATE = 6;

/**
 * The finger tip of one hand, and how far the arm has left its pose (`work`).
 *
 * Only a new touch counts, so a hand whose goal has not changed after the person's patience backs
 * off and touches once more; if that has no effect either, it withdraws and enters from outside.
 */
export class ReachingHand {
  goal: ScriptedGoal | null = null;
  tipM: Vector = [0, 0, 0];
  fingers: Vector = FORWARD;
  /** When the hand is out of its previous box; infinite while that is unknown. */
  outS = Number.POSITIVE_INFINITY;
  private path: SmoothPath | null = null;
  private pending: ScriptedGoal | null = null;
  private reactS = 0;
  private settleS = 0;
  private engaged = 0;
  private misses = 0;

  /** Share of the arm's pose that follows the goal, 0 to 1, changing smoothly. */
  get work(): number {
    return minimumJerk(this.engaged);
  }

  get isIdle(): boolean {
    return this.engaged === 0 && this.pending === null;
  }

  /** Act on a goal after the reaction time, waiting `settleS` in front of it for the body. */
  setGoal(goal: ScriptedGoal | null, timeS: number, reactionS: number, settleS = 0): void {
    this.pending = goal;
    this.reactS = timeS + reactionS;
    this.settleS = settleS;
    this.outS = Number.POSITIVE_INFINITY;
    if (goal === null) this.goal = null;
  }

  /** Advance by one frame; `hangingTipM` is where the tip is now if the arm was hanging. */
  follow(timeS: number, stepS: number, hangingTipM: Vector, aim: Aim, random: Random): void {
    if (this.pending !== null && timeS >= this.reactS) {
      this.setOff(timeS, hangingTipM, aim, random);
    } else if (this.goal !== null && this.path !== null) {
      if (timeS > this.path.endS + aim.traits.patienceS + aim.latencyS) {
        this.misses++;
        const isRetry = this.misses === 1;
        const wayOutM = isRetry ? backOff(this.goal) : this.goal.approachM;
        this.plan(this.goal, wayOutM, timeS, aim, random, isRetry);
      }
    }
    if (this.path !== null) this.tipM = this.path.at(timeS);
    const change = stepS / ENGAGE_S;
    this.engaged =
      this.goal !== null ? Math.min(1, this.engaged + change) : Math.max(0, this.engaged - change);
    this.turn(stepS);
  }

  private setOff(timeS: number, hangingTipM: Vector, aim: Aim, random: Random): void {
    const goal = this.pending;
    this.pending = null;
    if (goal === null) return;
    let wayOutM: Vector = [0, 0, 0];
    if (this.engaged === 0) this.tipM = hangingTipM;
    else if (this.goal !== null) wayOutM = this.goal.approachM;
    this.misses = 0;
    this.plan(goal, wayOutM, timeS, aim, random, false);
  }

  private plan(
    goal: ScriptedGoal,
    wayOutM: Vector,
    timeS: number,
    aim: Aim,
    random: Random,
    isRetry: boolean,
  ): void {
    // A second touch goes straight back in, because the hand is still in front of the surface.
    let path = aimedPath(
      aim,
      this.tipM,
      isRetry ? [0, 0, 0] : wayOutM,
      isRetry ? { ...goal, approachM: wayOutM } : goal,
      timeS,
      random,
      this.misses,
    );
    const hasLeft = length(wayOutM) > 0 && !isRetry;
    const first = path.moves[0];
    this.outS = (first?.startS ?? timeS) + (hasLeft ? OUT_SHARE * (first?.durationS ?? 0) : 0);
    const entering = hasLeft ? 2 : 1;
    if (length(goal.approachM) > 0 && !isRetry && entering < path.moves.length) {
      path = path.waitingToEnter(entering, this.outS + this.settleS);
    }
    this.path = path;
    this.goal = goal;
  }

  /** Turn the fingers towards the goal's opening. */
  private turn(stepS: number): void {
    const towards =
      this.goal === null ? FORWARD : times(unit(this.goal.approachM, times(FORWARD, -1)), -1);
    const share = Math.min(1, TURN_RATE * stepS);
    const mixed = plus(times(this.fingers, 1 - share), times(towards, share));
    this.fingers = unit(mixed, towards);
  }
}

function backOff({ approachM }: ScriptedGoal): Vector {
  const deepM = length(approachM);
  return deepM < 1e-6 ? [0, 0, BACK_OFF_M] : times(approachM, Math.min(1, BACK_OFF_M / deepM));
}
