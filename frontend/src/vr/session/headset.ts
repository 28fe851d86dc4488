/**
 * The headset: follows the session's state, moves the bodies, runs the phases, records.
 *
 * It is called once per frame, whoever calls: WebXR, the desktop's screen or a test with a clock of
 * its own. Everything that happens follows from the state that the server sends
 * (`docs/protocol.md`); `app/rehearsal/headset.py` is the same in Python, with the same order of
 * frames and reports.
 */
import { GOAL_PARTS } from "@shared/avatar/goals";
import type { Place as Pose } from "@shared/avatar/hips";
import type { Bodies, BodiesFrame } from "../bodies/bodies";
import type { Measures } from "../calibration";
import { RoadGround, type RoadLink } from "../road";
import { layoutsOf, Phases, RoadRun, type TaskLayout, type TimedRun } from "../tasks";
import {
  FINGER_VALUES_PER_FRAME,
  type HeadsetState,
  type PhaseOrder,
  type ReportBody,
  type TelemetryClient,
  VALUES_PER_FRAME,
} from "../telemetry";
import { SteadyGoals } from "../tracking/steady";
import type { GoalPart, GoalState, TrackedFrame, TrackingSource } from "../tracking/tracked";
import { Calibrating, type Keep } from "./calibrating";
import type { Guide, OpenRoad, Place, PrepareBodies, Scenery, StreetView } from "./ports";
import { Recorder } from "./recorder";
import { SleepWatch } from "./sleep";

/** Bodies are made anew before they are stepped into if a length has changed by this, m. */
const OTHER_BODY_M = 0.005;
/** A scene that broke off is begun anew, if the operator resumes, this long after the last one, s. */
const NEXT_SCENE_S = 5;

export interface HeadsetParts {
  readonly telemetry: TelemetryClient;
  readonly source: TrackingSource;
  /** Where a calibration is kept while the session lasts. */
  readonly keep: Keep;
  /** The start square is there, in the world of the tracked frames so far. */
  readonly onSquare: (worldFromSquare: Pose) => void;
  readonly prepareBodies: PrepareBodies;
  /** None in tests of studies without a road. */
  readonly openRoad?: OpenRoad;
  readonly scenery: Scenery;
  /** Panels and how one stops; none in tests of the loop alone. */
  readonly guide?: Guide;
  /** Whether the streams of fingers were announced. */
  readonly withFingers: boolean;
  /** Another body is worn from the next frame on, by its name; null is the configuration's. */
  readonly onBodyWorn: (body: string | null) => void;
  /** Called once if nothing more can be recorded, or the bodies cannot be prepared. */
  readonly onFailure: (error: unknown) => void;
}

export class Headset {
  /** When and how the participant is calibrated; its panel tells it what was pressed. */
  readonly calibrating: Calibrating;
  readonly #parts: HeadsetParts;
  readonly #recorder: Recorder;
  readonly #phases: Phases;
  readonly #sleep = new SleepWatch();
  readonly #steady = new SteadyGoals();
  #source: TrackingSource;
  #bodies: Bodies | null = null;
  /** What the bodies are made for, or are being made for. */
  #madeFor: Measures | null = null;
  #hasReportedBody = false;
  #bodyWorn: string | null = null;
  /** Surfaces by parts of the boxes that are shown. */
  #touchCount = 0;
  #revision = 0;
  #hasMoved = false;
  #isRecording = false;
  #goalStates = "";
  readonly #fingers = new Float64Array(FINGER_VALUES_PER_FRAME);
  #timeS = 0;
  #isFrozen = false;
  #isLookedAt = true;
  readonly #freezable = new ShownPose();
  readonly #ground: RoadGround | null;
  #road: RoadLink | null = null;
  #sceneS = 0;

  constructor(parts: HeadsetParts) {
    this.#parts = parts;
    this.#source = parts.source;
    this.#recorder = new Recorder(parts.telemetry, parts);
    this.calibrating = new Calibrating({
      sessionId: parts.telemetry.welcome.session_id,
      keep: parts.keep,
      report: (body) => this.#report([body]),
      onBegin: () => this.#phases.stop(this.#timeS, "calibration"),
      onChange: () => this.#steady.restart(),
      onSquare: parts.onSquare,
    });
    const { tasks, road } = parts.telemetry.welcome;
    this.#ground = road === undefined ? null : new RoadGround(road);
    const around = {
      report: (reports: readonly ReportBody[]) => this.#report(reports),
      enter: (order: PhaseOrder, layout: TaskLayout | null) => this.#enterPhase(order, layout),
      leave: () => this.#leavePhase(),
      touchingParts: () => this.#bodies?.touchingParts ?? [],
    };
    this.#phases = new Phases(layoutsOf(tasks), around, road ?? null);
  }

  /** The time of the newest frame, s. */
  get timeS(): number {
    return this.#timeS;
  }

  /** Frames recorded in this run, whether sent already or not. */
  get recorded(): number {
    return this.#recorder.nextSeq;
  }

  /** The bodies as they were computed last; null before. */
  get computed(): BodiesFrame | null {
    return this.#bodies?.latest() ?? null;
  }

  /** Where the participant is in the visit. */
  get place(): Place {
    return this.#placeIn(this.#parts.telemetry.state);
  }

  get run(): TimedRun | null {
    return this.#phases.run;
  }

  /** Track by other devices from the next frame on. */
  trackBy(source: TrackingSource): void {
    this.#source = source;
    this.#steady.restart();
  }

  /** Draw one frame. `timeS`: the client's monotonic time; `xr`: null without WebXR. */
  frame(timeS: number, xr: XRFrame | null): void {
    const { telemetry, scenery, guide } = this.#parts;
    const { calibrating } = this;
    const state = telemetry.state;
    const lastS = this.#sleep.lastS;
    const tracked = this.#source.read(timeS, xr);
    const sleep = this.#sleep.frame(timeS, xr === null ? null : tracked.eyes);
    this.#timeS = timeS;
    if (sleep === "still") this.#phases.stop(timeS, "asleep");
    // Some devices keep calling frames that nobody sees: each is as asleep as a gap.
    const isGap = sleep === "gap" || !this.#isSeen;
    if (isGap && lastS !== null) this.#phases.wake(lastS, timeS);
    calibrating.frame({
      state,
      isSettled: telemetry.settled,
      isInterrupted: isGap,
      tracked,
      source: this.#source,
      goalErrorsM: this.#bodies?.latest()?.goalErrorsM ?? null,
    });
    this.#follow(state, tracked);
    // As this frame is shown: the frame in which the time is up still moves.
    this.#isFrozen = this.#phases.run?.isFrozen ?? false;
    const bodies = this.#bodies;
    if (bodies !== null) {
      const steady = this.#steady.steady(tracked, calibrating.calibrator.goals(tracked));
      const isOnRoad = this.#ground !== null && this.#phases.run instanceof RoadRun;
      const statureM = this.#madeFor?.statureM ?? 0;
      const goals = isOnRoad ? this.#ground.carried(steady, hipsZM(bodies), statureM) : steady;
      bodies.step({ timeS, goals, fingers: this.#fingersOf(tracked) });
      this.#perform(bodies, state, tracked);
    }
    const shown = this.#bodies?.latest() ?? null;
    const { run } = this.#phases;
    const place = this.#placeIn(state);
    const calibration = calibrating.prompt;
    const moment = { timeS, place, state, tracked, run, calibration };
    const cover = guide?.follow(moment) ?? "none";
    const street = this.#streetAround(run, timeS);
    scenery.show({ ...moment, bodies: shown, street, isFrozen: this.#isFrozen, cover });
    this.#recorder.send(timeS);
  }

  /**
   * The headset is not looked at any more: its session was hidden, or has ended. The clock stops at
   * the last frame, and whatever the operator asks for waits until `lookAgain`.
   */
  leave(cause: string): void {
    this.#isLookedAt = false;
    if (this.#sleep.lastS !== null) this.#phases.stop(this.#sleep.lastS, cause);
    this.#recorder.end(this.#timeS);
  }

  /** The scene is looked at again: a request to resume that came meanwhile is carried out. */
  lookAgain(): void {
    this.#isLookedAt = true;
  }

  /** Stop the clock now, for a reason of the headset's own; the operator resumes. */
  stop(cause: string): void {
    this.#phases.stop(this.#timeS, cause);
  }

  /** The participant calls the experimenter; to stop also stops the clock, at this frame. */
  call(what: "stop" | "help"): void {
    this.#report([{ kind: "call", t_s: this.#timeS, what }]);
    if (what === "stop") this.stop("participant");
  }

  /**
   * The device has moved its origin: the clock stops, and the body moves over softly. `isKept`: where
   * the square is now is known; if not, the participant stands on it again.
   */
  recentred(isKept: boolean): void {
    this.#steady.restart();
    this.stop("recentred");
    if (!isKept) this.calibrating.squareLost();
  }

  dispose(): void {
    this.leave("closed");
    this.#road?.close();
    this.#bodies?.dispose();
    this.#bodies = null;
  }

  /** Whether the scene is in front of open eyes, as far as the device tells. */
  get #isSeen(): boolean {
    return this.#isLookedAt && !this.#sleep.isStill;
  }

  #perform(bodies: Bodies, state: HeadsetState, tracked: TrackedFrame): void {
    const shown = bodies.latest();
    if (shown === null) return;
    this.#hasMoved = true;
    const { telemetry } = this.#parts;
    const timeS = this.#timeS;
    const phases = this.#phases;
    this.#recorder.computed(shown);
    if (!this.#isFrozen) this.#freezable.keep(shown);
    if (this.#isRecording && !state.recording) this.#recorder.flush(timeS);
    this.#isRecording = state.recording;
    if (state.recording) {
      this.#reportGoals(tracked);
      const seen = this.#isFrozen ? this.#freezable : shown;
      this.#recorder.frame(timeS, seen, phases.phaseId, phases.run?.clockRuns ?? false);
    }
    const { connected } = telemetry.status;
    const goesOn = this.#isSeen && (connected || telemetry.welcome.on_disconnect === "continue");
    const { run } = phases;
    if (run instanceof RoadRun) this.#walk(run, shown);
    // The newest frame may have been computed before the boxes of this phase were there.
    phases.frame(timeS, shown.touched.length === this.#touchCount ? shown : null, goesOn);
    if (run !== null) this.#recorder.setActive(run.activeS(timeS));
  }

  /** Bring the headset in line with the session's state. */
  #follow(state: HeadsetState, tracked: TrackedFrame): void {
    if (state.materialised) this.#hasReportedBody = true;
    if (this.#hasReportedBody || state.step_kind === "materialise") this.#prepare(state);
    if (this.#bodies === null) return;
    if (state.step_kind === "materialise" && !this.#hasReportedBody) this.#materialise(tracked);
    this.#changeAvatar(state);
    // The clock stays where it is until the calibration is done, and while nobody sees the scene; the
    // operator resumes it.
    if (this.calibrating.isUnderway || !this.#isSeen) return;
    this.#phases.follow(state, this.#parts.telemetry.settled, this.#timeS);
  }

  /** The participant stands in the figure and presses both grips: the body appears. */
  #materialise({ hands }: TrackedFrame): void {
    if (this.calibrating.isDue) return;
    const isAsked = hands.left.isSqueezing && hands.right.isSqueezing;
    if (!isAsked || !this.#hasMoved) return;
    this.#hasReportedBody = true;
    this.#report([{ kind: "materialised", t_s: this.#timeS }]);
  }

  /**
   * Request every body of the study at once, for the measured lengths: they are ready when a block
   * begins, and neither the time nor the kind of a request reveals which is worn next. Somebody who is
   * measured again before stepping into the body gets another one.
   */
  #prepare(state: HeadsetState): void {
    const measures = this.calibrating.measures(state);
    if (measures === null) return;
    if (this.#madeFor !== null) {
      const isMaking = this.#bodies === null;
      if (isMaking || this.#hasReportedBody || !isOther(measures, this.#madeFor)) return;
      this.#bodies?.dispose();
      this.#bodies = null;
      this.#hasMoved = false;
    }
    this.#madeFor = measures;
    const { telemetry, prepareBodies, onFailure } = this.#parts;
    prepareBodies(measures, telemetry.welcome.bodies ?? []).then((bodies) => {
      this.#bodies = bodies;
    }, onFailure);
  }

  #changeAvatar({ avatar_changes: order }: HeadsetState): void {
    const bodies = this.#bodies;
    if (order === undefined || bodies === null || order.revision === this.#revision) return;
    this.#revision = order.revision;
    const report = (held_rad: Readonly<Record<string, number>>, problem: string | null) => {
      const { revision } = order;
      const applied = problem === null;
      const t_s = this.#timeS;
      const body = { kind: "avatar_changes", revision, t_s, applied, problem } as const;
      this.#report([{ ...body, held_rad: { ...held_rad } }]);
    };
    bodies.change(order).then(
      (heldRad) => report(heldRad, null),
      (error) => report({}, String(error instanceof Error ? error.message : error).slice(0, 300)),
    );
  }

  #enterPhase(order: PhaseOrder, layout: TaskLayout | null): void {
    const bodies = this.#bodies;
    if (bodies === null) return;
    const body = order.body ?? null;
    if (body !== this.#bodyWorn) {
      bodies.wear(body);
      this.#bodyWorn = body;
      this.#parts.onBodyWorn(body);
    }
    const orderedS = order.latency_ms / 1000;
    bodies.setLatency(orderedS);
    const surfaces = layout?.surfaces ?? [];
    this.#touchCount = surfaces.length * bodies.touchingParts.length;
    bodies.showSurfaces(surfaces.map(({ key }) => key));
    const { addedS } = bodies;
    this.#report([
      {
        kind: "added_latency",
        phase_id: order.phase_id,
        t_s: this.#timeS,
        added_s: addedS,
        compensated_s: Math.min(addedS, orderedS),
        runs_in: addedS > 0 ? "worker" : "page",
      },
    ]);
  }

  /**
   * Say where the participant is on the road. Its scene begins when they stand at the start; one that
   * broke off stops the clock, and another one begins when the operator resumes.
   */
  #walk(run: RoadRun, { remote }: BodiesFrame): void {
    const timeS = this.#timeS;
    const [x = 0, , z = 0] = remote;
    const places = run.walk(timeS, x, z);
    this.#road?.say(places, run.clockRuns);
    const isBroken = this.#road?.problem != null;
    if (isBroken && run.clockRuns) this.stop("road");
    if (isBroken && run.order.resuming && timeS - this.#sceneS > NEXT_SCENE_S) this.#leaveRoad();
    const { openRoad } = this.#parts;
    if (this.#road === null && openRoad !== undefined && run.awaits !== "start") {
      this.#sceneS = timeS;
      const place = run.enterScene(timeS, x, z);
      this.#road = openRoad(run.order.phase_id, run.activeS(timeS), place);
    }
    run.followTraffic(openRoad === undefined || this.#road?.hasTraffic === true);
  }

  #leaveRoad(): void {
    this.#road?.close();
    this.#road = null;
  }

  #streetAround(run: TimedRun | null, timeS: number): StreetView | null {
    if (this.#ground === null || this.#bodies === null || !(run instanceof RoadRun)) return null;
    const sunkM = this.#ground.sunkM(hipsZM(this.#bodies));
    const others = this.#road?.others ?? NOBODY;
    return { sunkM, others, activeS: run.activeS(timeS), showsStart: run.awaits === "start" };
  }

  #leavePhase(): void {
    this.#leaveRoad();
    this.#bodies?.setLatency(0);
    this.#bodies?.showSurfaces([]);
    this.#recorder.flush(this.#timeS);
  }

  /** Say how every goal is known from the next frame on, if that has changed. */
  #reportGoals({ parts }: TrackedFrame): void {
    let states = this.#source.kind as string;
    for (const part of GOAL_PARTS) states += parts[part].state.charAt(0);
    if (states === this.#goalStates) return;
    this.#goalStates = states;
    const named = GOAL_PARTS.map((part) => [part, parts[part].state]);
    this.#report([
      {
        kind: "goals",
        t_s: this.#timeS,
        frame_seq: this.#recorder.nextSeq,
        source: this.#source.kind,
        states: Object.fromEntries(named) as Record<GoalPart, GoalState>,
      },
    ]);
  }

  #report(bodies: readonly ReportBody[]): void {
    for (const body of bodies) this.#recorder.report(body);
  }

  /** The fingers of both hands, NaN where a hand is not tracked; null if they are not recorded. */
  #fingersOf({ hands }: TrackedFrame): Float64Array | null {
    if (!this.#parts.withFingers) return null;
    const values = this.#fingers.fill(Number.NaN);
    if (hands.left.fingers !== null) values.set(hands.left.fingers, 0);
    if (hands.right.fingers !== null) values.set(hands.right.fingers, values.length / 2);
    return values;
  }

  #placeIn(state: HeadsetState): Place {
    if (state.status === "completed" || state.status === "aborted") return "over";
    if (state.status === "withdrawn") return "over";
    if (state.materialised || this.#hasReportedBody) return "acting";
    if (state.step_kind !== "materialise") return "standby";
    return this.calibrating.isDue ? "calibrating" : "stepping_in";
  }
}

const NOBODY = { activeS: 0, actors: [] };

/** Where the shown body's hips are, z; 0 before there is one. */
const hipsZM = (bodies: Bodies): number => bodies.latest()?.remote[2] ?? 0;

/** What the participant saw last: it stays in view while the avatar is frozen. */
class ShownPose {
  readonly remote = new Float64Array(VALUES_PER_FRAME);
  readonly #fingers = new Float64Array(FINGER_VALUES_PER_FRAME);
  remoteFingers: Float64Array | null = null;

  keep({ remote, remoteFingers }: BodiesFrame): void {
    this.remote.set(remote);
    if (remoteFingers !== null) this.#fingers.set(remoteFingers);
    this.remoteFingers = remoteFingers === null ? null : this.#fingers;
  }
}

/** Whether a body for these lengths differs from one for those by more than can be seen. */
function isOther(one: Measures, other: Measures): boolean {
  const names = new Set([...Object.keys(one.segmentsM), ...Object.keys(other.segmentsM)]);
  const areOther = (a = 0, b = 0) => Math.abs(a - b) > OTHER_BODY_M;
  return (
    areOther(one.statureM, other.statureM) ||
    [...names].some((name) => areOther(one.segmentsM[name], other.segmentsM[name]))
  );
}
