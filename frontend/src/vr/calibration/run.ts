/**
 * The steps of a calibration, from the first frame to a calibration that was tested.
 *
 *     square     stand on the square, look ahead     -> the origin of the world
 *     n_pose     upright, arms hanging, 2 s          -> height of the eyes, sides of the shins
 *     t_pose     arms out, 2 s                       -> arms, offsets of all devices, sides
 *     squat      bend the knees and stand up         -> knees that were bent; error of the goals
 *     reach      both hands forwards                 -> error of the goals
 *     mirror     the participant sees the body move  -> once more, if something is wrong
 *
 * A goal that is further than 3 cm from the body in squat and reach, or knees that were bent, lead
 * back to the N-pose once. What is asked for and not done is waited for in patience, then left as it
 * is and said in the calibration's notices: nobody is held up by a device. A run knows nothing of the
 * session, and can be made again at any time.
 */
import { GOAL_PARTS } from "@shared/avatar/goals";
import type { Place } from "@shared/avatar/hips";
import type { GoalPart, SourceKind, TrackedFrame } from "../tracking/tracked";
import { type Calibration, type Notice, unmeasured } from "./calibration";
import { USUAL_STATURE_M } from "./calibrator";
import { BELOW_STATED_M, bodyPlace, fitted, HANDS, statureOf, UNEVEN_M } from "./fitting";
import { type HeldPose, PoseMean } from "./heldPose";
import {
  isBent,
  isReaching,
  isUpright,
  nPoseProblems,
  squareProblems,
  tPoseProblems,
} from "./poses";
import {
  CALIBRATION_STEPS,
  type CalibrationProblem,
  type CalibrationPrompt,
  type CalibrationStep,
} from "./steps";

export interface RunOptions {
  /** What the participant said, or what was matched; null if nothing is known. */
  readonly statedStatureM: number | null;
  /** The stature of the body that is worn already and stays; null before there is one. */
  readonly bodyStatureM: number | null;
  /** The square comes to where the participant stands; else the participant goes to it. */
  readonly movesSquare: boolean;
  /** Only find the origin again and keep this calibration, such as after a recentring. */
  readonly keeping?: Calibration;
}

/** What tracks the participant, as of a `TrackingSource`. */
export interface Tracks {
  readonly kind: SourceKind;
  readonly measures: ReadonlySet<GoalPart>;
}

/** A goal further than this from the body is calibrated once more. */
export const MOST_ERROR_M = 0.03;
const STAND_S = 1;
const HOLD_S = 2;
/** A body that is not made within this does not hold anybody up. */
const BODY_S = 15;
/** Whoever comes up again has arrived when nothing moves by more than this. */
const UPRIGHT_STILL_M = 0.02;
const UPRIGHT_S = 0.7;
const REACH_S = 0.6;
const MIRROR_S = 8;
/** A movement that was not made after this is asked for once more. */
const ASK_AFTER_S = 4;
/** After this, a step may be left out by a press; a test that is not made is left out by itself. */
const SKIP_AFTER_S = 30;
const GIVE_UP_S = 20;
/** Inverse kinematics needs a moment after new offsets. */
const SETTLE_S = 0.5;
const LARGE_SHARE = 0.9;
const MOST_ATTEMPTS = 2;
/** How long each problem is asked to be mended; without an entry: until it is. */
const PATIENCE_S: Partial<Record<CalibrationProblem["kind"], number>> = {
  swapped_hands: 15,
  bent_knees: 10,
  bent_elbows: 10,
  palms_not_down: 10,
  feet_apart: 10,
};
/** What is said of a problem that was left as it is; the fit itself says the others. */
const NOTICE_OF: Partial<Record<CalibrationProblem["kind"], Notice>> = {
  bent_elbows: "bent_elbows",
};

type Step = CalibrationStep | "done";

export class CalibrationRun {
  readonly #options: RunOptions;
  #step: Step = "square";
  #problem: CalibrationProblem | null = null;
  #again: CalibrationProblem | null = null;
  #attempt = 1;
  #stepSinceS: number | null = null;
  #nowS = 0;
  #holdS = STAND_S;
  #pose = new PoseMean(STAND_S);
  #heldSinceS: number | null = null;
  #wasLow = false;
  #awaitsBodySinceS: number | null = null;
  #n: HeldPose | null = null;
  #fit: Calibration | null = null;
  #square: Place | null = null;
  /** For how long each problem has been shown in this attempt. */
  readonly #shownS = new Map<CalibrationProblem["kind"], number>();
  readonly #found = new Set<Notice>();
  readonly #errors = new Map<GoalPart, number[]>();

  constructor(options: RunOptions) {
    this.#options = options;
  }

  get isDone(): boolean {
    return this.#step === "done";
  }

  /** What participant and operator are shown; null once it is done. */
  get prompt(): CalibrationPrompt | null {
    const step = this.#step;
    if (step === "done") return null;
    const steps = this.#options.keeping === undefined ? CALIBRATION_STEPS : (["square"] as const);
    const waitedS = this.#nowS - (this.#stepSinceS ?? this.#nowS);
    return {
      step,
      number: steps.indexOf(step as "square") + 1,
      total: steps.length,
      problem: this.#problem,
      held: this.#held,
      secondsLeft: Math.ceil((1 - this.#held) * (step === "mirror" ? MIRROR_S : this.#holdS)),
      again: this.#again,
      canSkip: step !== "mirror" && waitedS > SKIP_AFTER_S,
    };
  }

  /**
   * The calibration so far, from the T-pose on: to be used at once, so that squat and reach test it.
   */
  get calibration(): Calibration | null {
    return this.#fit;
  }

  /**
   * Where the start square is in the frame of the tracked frames, once it was found; returned once.
   * The source reports in the square's frame from then on.
   */
  takeSquare(): Place | null {
    const square = this.#square;
    this.#square = null;
    return square;
  }

  /**
   * Advance by a frame. `goalErrorsM`: what inverse kinematics left of each goal's distance, in the
   * order of `GOAL_PARTS`, NaN without a goal; null while there is no body.
   */
  frame(tracked: TrackedFrame, tracks: Tracks, goalErrorsM: ArrayLike<number> | null): void {
    const sinceLastS = Math.max(0, tracked.timeS - this.#nowS);
    this.#nowS = tracked.timeS;
    this.#stepSinceS ??= tracked.timeS;
    if (this.#awaitsBodySinceS !== null) {
      this.#awaitBody(this.#awaitsBodySinceS, goalErrorsM !== null);
      return;
    }
    switch (this.#step) {
      case "square": {
        const problems = squareProblems(tracked, this.#options.movesSquare);
        this.#hold(tracked, problems, sinceLastS, (held) => this.#foundSquare(held));
        break;
      }
      case "n_pose": {
        const { statedStatureM: statedM } = this.#options;
        const leastM = statedM === null ? null : statedM - BELOW_STATED_M;
        this.#hold(tracked, nPoseProblems(tracked, leastM), sinceLastS, (held) => {
          this.#n = held;
          this.#enter("t_pose", HOLD_S);
        });
        break;
      }
      case "t_pose": {
        const n = this.#n as HeldPose;
        const problems = tPoseProblems(tracked, n);
        this.#hold(tracked, problems, sinceLastS, (held) => this.#use(n, held, tracks));
        break;
      }
      case "squat":
        this.#measure(goalErrorsM);
        this.#squat(tracked);
        break;
      case "reach":
        this.#measure(goalErrorsM);
        this.#reach(tracked);
        break;
      case "mirror":
        if (this.#held >= 1) this.confirm();
        break;
      default:
        break;
    }
  }

  /** The mirror shows the participant's pose: the calibration is done. */
  confirm(): void {
    if (this.#step === "mirror") this.#enter("done", 0);
  }

  /** Something is wrong: once more from the N-pose. */
  repeat(): void {
    if (this.#step === "done" || this.#step === "square") return;
    this.#attempt = 0;
    this.#restart(null);
  }

  /** Begin the step again, such as after somebody has stopped in the middle of it. */
  restartStep(): void {
    if (this.#step !== "done") this.#enter(this.#step, this.#holdS);
  }

  /** Leave out what a person cannot do. */
  skip(tracks: Tracks): void {
    const n = this.#n;
    switch (this.#step) {
      case "square":
      case "n_pose":
        this.#fit = this.#options.keeping ?? this.#unmeasured();
        this.#enter("done", 0);
        break;
      case "t_pose":
        if (n !== null) this.#use(n, withoutHands(n), tracks);
        break;
      case "squat":
      case "reach":
        this.#leaveOut();
        break;
      default:
        break;
    }
  }

  get #held(): number {
    if (this.#step !== "mirror") return this.#pose.progress(this.#nowS);
    return Math.min(1, (this.#nowS - (this.#stepSinceS ?? this.#nowS)) / MIRROR_S);
  }

  /** Wait until a pose without problems has been held long enough. */
  #hold(
    tracked: TrackedFrame,
    problems: readonly CalibrationProblem[],
    sinceLastS: number,
    then: (held: HeldPose) => void,
  ): void {
    const problem = problems.find(({ kind }) => !this.#isLeft(kind)) ?? null;
    this.#problem = problem;
    if (problem !== null) {
      const { kind } = problem;
      this.#shownS.set(kind, (this.#shownS.get(kind) ?? 0) + sinceLastS);
      this.#pose.restart();
      return;
    }
    // Whoever has just taken the pose is not told to keep still at once.
    const isStill = this.#pose.add(tracked);
    if (!isStill && this.#waitedS > ASK_AFTER_S) this.#problem = { kind: "moving" };
    const held = this.#pose.held(tracked.timeS);
    if (held === null) return;
    for (const { kind } of problems) {
      const notice = NOTICE_OF[kind];
      if (notice !== undefined) this.#found.add(notice);
    }
    then(held);
  }

  /** Whether a problem was asked to be mended for long enough, and is left as it is. */
  #isLeft(kind: CalibrationProblem["kind"]): boolean {
    return (this.#shownS.get(kind) ?? 0) > (PATIENCE_S[kind] ?? Number.POSITIVE_INFINITY);
  }

  #foundSquare(held: HeldPose): void {
    const { keeping, movesSquare } = this.#options;
    if (movesSquare) this.#square = bodyPlace({ eyes: held.eyes, parts: new Map() });
    if (keeping === undefined) {
      this.#enter("n_pose", HOLD_S);
      return;
    }
    this.#fit = keeping;
    this.#enter("done", 0);
  }

  #use(n: HeldPose, t: HeldPose, { kind, measures }: Tracks): void {
    const { statedStatureM, bodyStatureM } = this.#options;
    const fit = fitted(n, t, { source: kind, measures, statedStatureM, bodyStatureM });
    this.#fit = { ...fit, notices: [...fit.notices, ...this.#found] };
    this.#errors.clear();
    this.#found.clear();
    if (this.#attempt < MOST_ATTEMPTS && fit.notices.includes("bent_knees"))
      this.#restart({ kind: "bent_knees" });
    else this.#awaitsBodySinceS = this.#nowS;
  }

  /** The tests need a body that is made for what was measured. */
  #awaitBody(sinceS: number, isThere: boolean): void {
    if (!isThere && this.#nowS - sinceS < BODY_S) return;
    this.#awaitsBodySinceS = null;
    this.#enter("squat", UPRIGHT_S);
  }

  /** Wait until the participant was low and is upright again; look at the knees then. */
  #squat(tracked: TrackedFrame): void {
    const fit = this.#fit as Calibration;
    const eyeHeightM = fit.eyeHeightM ?? Number.NaN;
    if (this.#waitedS > GIVE_UP_S) {
      this.#leaveOut();
      return;
    }
    if (isBent(tracked, eyeHeightM)) this.#wasLow = true;
    if (!this.#wasLow) {
      this.#problem = this.#waitedS > ASK_AFTER_S ? { kind: "not_bent" } : null;
      this.#pose.restart();
      return;
    }
    if (!isUpright(tracked, eyeHeightM)) {
      this.#problem = this.#waitedS > 2 * ASK_AFTER_S ? { kind: "not_upright" } : null;
      this.#pose.restart();
      return;
    }
    this.#problem = null;
    this.#pose.add(tracked);
    const held = this.#pose.held(tracked.timeS);
    if (held === null) return;
    if (statureOf(held.eyes) > fit.statureM + UNEVEN_M) this.#found.add("bent_knees");
    this.#next();
  }

  #reach(tracked: TrackedFrame): void {
    if (this.#waitedS > GIVE_UP_S) {
      this.#leaveOut();
      return;
    }
    const reaches = isReaching(tracked);
    this.#problem = !reaches && this.#waitedS > ASK_AFTER_S ? { kind: "not_reached" } : null;
    if (!reaches) this.#heldSinceS = null;
    else this.#heldSinceS ??= tracked.timeS;
    if (this.#heldSinceS !== null && tracked.timeS - this.#heldSinceS >= REACH_S) this.#next();
  }

  get #waitedS(): number {
    return this.#nowS - (this.#stepSinceS ?? this.#nowS);
  }

  /** A test is not made: what it would have shown is not known. */
  #leaveOut(): void {
    this.#found.add("not_tested");
    this.#next();
  }

  #measure(goalErrorsM: ArrayLike<number> | null): void {
    if (goalErrorsM === null || this.#waitedS < SETTLE_S) return;
    for (const [row, part] of GOAL_PARTS.entries()) {
      const errorM = goalErrorsM[row] ?? Number.NaN;
      if (!Number.isFinite(errorM)) continue;
      const errors = this.#errors.get(part);
      if (errors === undefined) this.#errors.set(part, [errorM]);
      else errors.push(errorM);
    }
  }

  #next(): void {
    if (this.#step === "squat") this.#enter("reach", 0);
    else this.#assess();
  }

  /** All poses were made: once more where something was wrong, else on to the mirror. */
  #assess(): void {
    const fit = this.#fit as Calibration;
    const residuals = [...this.#errors].map(([part, errors]) => [part, large(errors)] as const);
    if (residuals.length === 0) this.#found.add("not_tested");
    const worst = [...residuals].sort(([, a], [, b]) => b - a)[0];
    const isOff = worst !== undefined && worst[1] > MOST_ERROR_M;
    if (isOff) this.#found.add("goal_error");
    const notices = [...new Set([...fit.notices, ...this.#found])];
    this.#fit = { ...fit, notices, residualsM: Object.fromEntries(residuals) };
    if (this.#attempt >= MOST_ATTEMPTS) this.#enter("mirror", 0);
    else if (this.#found.has("bent_knees")) this.#restart({ kind: "bent_knees" });
    else if (isOff) this.#restart({ kind: "goal_error", part: worst[0], errorM: worst[1] });
    else this.#enter("mirror", 0);
  }

  #unmeasured(): Calibration {
    const { bodyStatureM, statedStatureM } = this.#options;
    const statureM = bodyStatureM ?? statedStatureM ?? USUAL_STATURE_M;
    return unmeasured(statureM, null, "usual_offsets");
  }

  #restart(again: CalibrationProblem | null): void {
    this.#attempt++;
    this.#again = again;
    this.#shownS.clear();
    this.#found.clear();
    this.#errors.clear();
    this.#enter("n_pose", HOLD_S);
  }

  #enter(step: Step, holdS: number): void {
    this.#step = step;
    this.#holdS = holdS;
    this.#pose = new PoseMean(holdS, step === "squat" ? UPRIGHT_STILL_M : undefined);
    this.#stepSinceS = null;
    this.#heldSinceS = null;
    this.#wasLow = false;
    this.#problem = null;
  }
}

/** The N-pose alone, for somebody whose arms cannot be measured. */
const withoutHands = (n: HeldPose): HeldPose => ({
  ...n,
  parts: new Map([...n.parts].filter(([part]) => !HANDS.some((hand) => hand === part))),
});

/** An error that few frames exceed. */
function large(errors: readonly number[]): number {
  const sorted = [...errors].sort((a, b) => a - b);
  return sorted[Math.min(sorted.length - 1, Math.floor(LARGE_SHARE * sorted.length))] as number;
}
