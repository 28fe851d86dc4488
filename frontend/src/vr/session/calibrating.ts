/**
 * Calibration in the visit: when the participant is calibrated, and what follows from the result.
 *
 * - The first time is before stepping into the body, which is made for the measured lengths.
 * - The operator orders it again at any time: a running phase is paused, everything else stays, and
 *   the same phase goes on when the operator resumes it. The operator's shifts are applied as they
 *   come.
 * - When the device has moved its origin and cannot say where to, only the square is found again.
 * - A script, a capture or a page on a screen moves a body of known measures: nothing is calibrated,
 *   and that is reported.
 *
 * The result is reported, and kept on the device for as long as the session lasts: a page that is
 * loaded again goes on with it. Without one the usual offsets are used, and that is reported, too.
 */
import type { Place } from "@shared/avatar/hips";
import {
  type Calibration,
  CalibrationRun,
  Calibrator,
  type Cause,
  calibrationFrom,
  calibrationReport,
  calibrationText,
  isMeasured,
  type Measures,
  USUAL_STATURE_M,
  unmeasured,
} from "../calibration";
import type { CalibrationPrompt } from "../calibration/steps";
import type { HeadsetState, ReportBody } from "../telemetry";
import type { TrackedFrame, TrackingSource } from "../tracking/tracked";

/** Where a calibration is kept on the device; `localStorage` is one. */
export type Keep = Pick<Storage, "getItem" | "setItem" | "removeItem">;

export interface CalibratingParts {
  readonly sessionId: string;
  readonly keep: Keep;
  readonly report: (body: ReportBody) => void;
  /** A calibration begins: the clock of a running phase stops. */
  readonly onBegin: () => void;
  /** The goals are elsewhere from now on: the body moves over softly. */
  readonly onChange: () => void;
  /** The start square is there, in the world of the tracked frames so far. */
  readonly onSquare: (worldFromSquare: Place) => void;
}

/** What the loop knows of one frame. */
export interface Moment {
  readonly state: HeadsetState;
  /** Whether the state includes all reports. */
  readonly isSettled: boolean;
  /** Nobody has seen the scene since the last frame: the device slept, or shows something else. */
  readonly isInterrupted: boolean;
  readonly tracked: TrackedFrame;
  readonly source: TrackingSource;
  /** The distances that inverse kinematics left, of the newest frame; null without bodies. */
  readonly goalErrorsM: ArrayLike<number> | null;
}

interface Underway {
  readonly run: CalibrationRun;
  readonly cause: Cause;
  readonly revision: number | null;
  /** What the operator was told last. */
  told: string;
  toldS: number;
}

const KEY = "reembody.calibration.";
const SQUARE_KEY = "reembody.square.";
const NO_SHIFTS = "{}";
const OVER: ReadonlySet<string> = new Set(["completed", "aborted", "withdrawn"]);
/** What changes more often than this is not worth telling. */
const TELL_EVERY_S = 1;

export class Calibrating {
  readonly calibrator = new Calibrator();
  readonly #parts: CalibratingParts;
  #underway: Underway | null = null;
  #source: TrackingSource | null = null;
  #isReady = false;
  #isSquareLost = false;
  #answered = 0;
  /** The order whose shifts are applied, and these shifts as text. */
  #shiftedBy: unknown = null;
  #shifts = NO_SHIFTS;
  /** The stature of the body that was stepped into. */
  #bodyStatureM: number | null = null;

  constructor(parts: CalibratingParts) {
    this.#parts = parts;
    const text = parts.keep.getItem(KEY + parts.sessionId);
    const kept = text === null ? null : calibrationFrom(text);
    if (kept === null) return;
    this.calibrator.use(kept);
    this.#isReady = true;
  }

  /** What participant and operator are shown; null while nobody is calibrated. */
  get prompt(): CalibrationPrompt | null {
    return this.#underway?.run.prompt ?? null;
  }

  get isUnderway(): boolean {
    return this.#underway !== null;
  }

  /** Whether somebody who steps into the body now has to be calibrated before. */
  get isDue(): boolean {
    return !this.#isReady || this.#underway !== null;
  }

  /** What the body is to be made for; null before it is known. */
  measures(state: HeadsetState): Measures | null {
    const { stature_m: statedM } = state.participant;
    const { calibration } = this.calibrator;
    if (calibration !== null && isMeasured(calibration)) return calibration;
    if (!this.#isReady) return null;
    return { statureM: statedM ?? calibration?.statureM ?? USUAL_STATURE_M, segmentsM: {} };
  }

  /** Call once a frame, before the goals of the frame are asked for. */
  frame(moment: Moment): void {
    const { state } = moment;
    this.#source = moment.source;
    if (OVER.has(state.status)) {
      this.#underway = null;
      const { keep, sessionId } = this.#parts;
      for (const key of [KEY, SQUARE_KEY]) keep.removeItem(key + sessionId);
      return;
    }
    if (this.#underway === null) this.#begin(moment);
    // Who has stopped is left alone until the experimenter has come; a pose that nobody was seen to
    // hold is none.
    const isLeftAlone = state.panel?.called === true || moment.isInterrupted;
    if (isLeftAlone) this.#underway?.run.restartStep();
    else if (this.#underway !== null) this.#advance(this.#underway, moment);
    this.#shift(state);
  }

  /**
   * Where the start square lies in the device's own floor space, as an earlier page of the session
   * left it; null if there was none. Devices keep their room for longer than a page lives.
   */
  get keptSquare(): Place | null {
    const { keep, sessionId } = this.#parts;
    return placeFrom(keep.getItem(SQUARE_KEY + sessionId));
  }

  /** The square lies there now in the device's floor space: keep it for a page that is loaded again. */
  keepSquare({ positionM, rotation }: Place): void {
    const { keep, sessionId } = this.#parts;
    keep.setItem(SQUARE_KEY + sessionId, JSON.stringify([...positionM, ...rotation]));
  }

  /** The device has moved its origin, and where the square was is not known. */
  squareLost(): void {
    this.#isSquareLost = true;
  }

  /** A button of the calibration's panel was pressed. */
  press(target: string): void {
    const run = this.#underway?.run;
    if (run === undefined || this.#source === null) return;
    if (target === "good") run.confirm();
    if (target === "bad") run.repeat();
    if (target === "skip") run.skip(this.#source);
  }

  #begin({ state, isSettled, tracked, source }: Moment): void {
    const { timeS } = tracked;
    const order = state.calibration;
    if (state.materialised) this.#bodyStatureM ??= this.measures(state)?.statureM ?? null;
    const isOrdered = order?.calibrate === true && isSettled && order.revision > this.#answered;
    if (source.knownBody !== null) {
      if (this.#isReady && !isOrdered) return;
      const { statureM, spanM } = source.knownBody;
      const known = unmeasured(statureM, spanM, "nothing_worn");
      const sources = Object.fromEntries([...source.measures].map((part) => [part, source.kind]));
      const revision = isOrdered ? order.revision : null;
      this.#finish({ ...known, sources }, timeS, isOrdered ? "order" : "first", revision);
    } else if (isOrdered) {
      this.#start(state, "order", order.revision);
    } else if (!this.#isReady && state.materialised) {
      // The page was loaded again, and the device does not know what was measured.
      const statureM = state.participant.stature_m ?? USUAL_STATURE_M;
      this.#finish(unmeasured(statureM, null, "usual_offsets"), timeS, "first", null);
    } else if (!this.#isReady && state.step_kind === "materialise") {
      this.#start(state, "first", null);
    } else if (this.#isSquareLost && this.calibrator.calibration !== null) {
      this.#start(state, "reset", null);
    }
  }

  #start(state: HeadsetState, cause: Cause, revision: number | null): void {
    const { calibration } = this.calibrator;
    const run = new CalibrationRun({
      statedStatureM: state.participant.stature_m,
      bodyStatureM: this.#bodyStatureM,
      // Later the boxes stay where they are, unless nobody knows where that is.
      movesSquare: cause === "first" || this.#isSquareLost,
      ...(cause === "reset" && calibration !== null && { keeping: calibration }),
    });
    this.#underway = { run, cause, revision, told: "", toldS: Number.NEGATIVE_INFINITY };
    this.#parts.onBegin();
  }

  #advance(underway: Underway, { tracked, source, goalErrorsM }: Moment): void {
    const { run, cause, revision } = underway;
    const before = run.calibration;
    run.frame(tracked, source, goalErrorsM);
    const square = run.takeSquare();
    if (square !== null) {
      this.#isSquareLost = false;
      this.#parts.onSquare(square);
      this.#parts.onChange();
    }
    const { calibration } = run;
    if (calibration !== null && calibration !== before) {
      this.#use(calibration);
      this.#parts.onChange();
    }
    if (run.isDone && calibration !== null) {
      this.#finish(calibration, tracked.timeS, cause, revision);
    } else this.#tell(underway, tracked.timeS);
  }

  #finish(calibration: Calibration, timeS: number, cause: Cause, revision: number | null): void {
    const { keep, sessionId, report } = this.#parts;
    this.#underway = null;
    this.#isReady = true;
    if (revision !== null) this.#answered = revision;
    this.#use(calibration);
    if (isMeasured(calibration)) keep.setItem(KEY + sessionId, calibrationText(calibration));
    report(calibrationReport(calibration, timeS, cause, revision));
  }

  #use(calibration: Calibration): void {
    this.calibrator.use(calibration);
    this.#shifts = NO_SHIFTS;
  }

  /** Tell the operator which step it is and what is wrong, when that has changed. */
  #tell(underway: Underway, timeS: number): void {
    const { prompt } = underway.run;
    if (prompt === null || timeS - underway.toldS < TELL_EVERY_S) return;
    const { step, number, total, problem } = prompt;
    const told = `${step} ${problem?.kind}`;
    if (told === underway.told) return;
    underway.told = told;
    underway.toldS = timeS;
    this.#parts.report({
      kind: "calibration_step",
      t_s: timeS,
      step,
      number,
      total,
      problem: problem?.kind ?? null,
    });
  }

  /** Apply the operator's shifts as they change; a new calibration starts without any. */
  #shift({ calibration }: HeadsetState): void {
    if (calibration === undefined || calibration === this.#shiftedBy) return;
    this.#shiftedBy = calibration;
    // Every state has them anew, whatever it was sent for; the goals move over only if they differ.
    const shifts = JSON.stringify(calibration.shifts_m);
    if (shifts === this.#shifts) return;
    this.#shifts = shifts;
    this.calibrator.shift(calibration.shifts_m);
    this.#parts.onChange();
  }
}

function placeFrom(text: string | null): Place | null {
  try {
    const values: unknown = JSON.parse(text ?? "null");
    if (!Array.isArray(values) || values.length !== 7 || !values.every(Number.isFinite))
      return null;
    const [x, y, z, ...rotation] = values as [number, number, number, ...number[]];
    return { positionM: [x, y, z], rotation: rotation as unknown as Place["rotation"] };
  } catch {
    return null;
  }
}
