/**
 * The headset: follows the session's state, moves the bodies, runs the phases, records.
 *
 * It is called once per frame, whoever calls: WebXR, the desktop's screen or a test with a clock of
 * its own. Everything that happens follows from the state that the server sends
 * (`docs/protocol.md`); `app/rehearsal/headset.py` is the same in Python, with the same order of
 * frames and reports.
 */
import { GOAL_PARTS, type Goals } from "@shared/avatar/goals";
import type { Bodies, BodiesFrame } from "../bodies/bodies";
import { layoutsOf, Phases, type TaskLayout, type TimedRun } from "../tasks";
import {
  FINGER_VALUES_PER_FRAME,
  type HeadsetState,
  type PhaseOrder,
  type ReportBody,
  type TelemetryClient,
  VALUES_PER_FRAME,
} from "../telemetry";
import type { GoalPart, GoalState, TrackedFrame, TrackingSource } from "../tracking/tracked";
import type { Calibrator, Place, PrepareBodies, Scenery } from "./ports";
import { Recorder } from "./recorder";
import { SleepWatch } from "./sleep";

/** The stature of a participant of whom nothing is known yet, m. */
const USUAL_STATURE_M = 1.72;

export interface HeadsetParts {
  readonly telemetry: TelemetryClient;
  readonly source: TrackingSource;
  readonly calibrator: Calibrator;
  readonly prepareBodies: PrepareBodies;
  readonly scenery: Scenery;
  /** Whether the streams of fingers were announced. */
  readonly withFingers: boolean;
  /** Another body is worn from the next frame on, by its name; null is the configuration's. */
  readonly onBodyWorn: (body: string | null) => void;
  /** Called once if nothing more can be recorded, or the bodies cannot be prepared. */
  readonly onFailure: (error: unknown) => void;
}

export class Headset {
  readonly #parts: HeadsetParts;
  readonly #recorder: Recorder;
  readonly #phases: Phases;
  readonly #sleep = new SleepWatch();
  #source: TrackingSource;
  #bodies: Bodies | null = null;
  #isPreparing = false;
  #hasReportedBody = false;
  #bodyWorn: string | null = null;
  /** Surfaces by parts of the boxes that are shown. */
  #touchCount = 0;
  #revision = 0;
  #hasMoved = false;
  #goalStates = "";
  readonly #fingers = new Float64Array(FINGER_VALUES_PER_FRAME);
  #timeS = 0;
  #isFrozen = false;
  readonly #freezable = new ShownPose();

  constructor(parts: HeadsetParts) {
    this.#parts = parts;
    this.#source = parts.source;
    this.#recorder = new Recorder(parts.telemetry, parts);
    this.#phases = new Phases(layoutsOf(parts.telemetry.welcome.tasks), {
      report: (reports) => this.#report(reports),
      enter: (order, layout) => this.#enterPhase(order, layout),
      leave: () => this.#leavePhase(),
      touchingParts: () => this.#bodies?.touchingParts ?? [],
    });
  }

  /** The time of the newest frame, s. */
  get timeS(): number {
    return this.#timeS;
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
  }

  /** Draw one frame. `timeS`: the client's monotonic time; `xr`: null without WebXR. */
  frame(timeS: number, xr: XRFrame | null): void {
    const { telemetry, calibrator, scenery } = this.#parts;
    const state = telemetry.state;
    const lastS = this.#sleep.lastS;
    const tracked = this.#source.read(timeS, xr);
    const sleep = this.#sleep.frame(timeS, xr === null ? null : tracked.eyes);
    this.#timeS = timeS;
    if (sleep === "gap" && lastS !== null) this.#phases.wake(lastS, timeS);
    if (sleep === "still") this.#phases.stop(timeS, "asleep");
    this.#follow(state, tracked);
    // As this frame is shown: the frame in which the time is up still moves.
    this.#isFrozen = this.#phases.run?.isFrozen ?? false;
    const bodies = this.#bodies;
    if (bodies !== null) {
      // A script or a capture moves joints; devices have to be calibrated first.
      const goals =
        this.#source.knownBody === null ? calibrator.goals(tracked) : placesOf(tracked.parts);
      bodies.step({ timeS, goals, fingers: this.#fingersOf(tracked) });
      this.#perform(bodies, state, tracked);
    }
    const shown = this.#bodies?.latest() ?? null;
    const { run } = this.#phases;
    const place = this.#placeIn(state);
    scenery.show({
      timeS,
      place,
      state,
      tracked,
      bodies: shown,
      run,
      isFrozen: this.#isFrozen,
      isCurtainDrawn: false,
    });
    this.#recorder.send(timeS);
  }

  /**
   * The headset is not looked at any more: its session was hidden, or has ended. The clock stops at
   * the last frame.
   */
  leave(cause: string): void {
    if (this.#sleep.lastS !== null) this.#phases.stop(this.#sleep.lastS, cause);
    this.#recorder.end(this.#timeS);
  }

  /** Stop the clock now, for a reason of the headset's own; the operator resumes. */
  stop(cause: string): void {
    this.#phases.stop(this.#timeS, cause);
  }

  dispose(): void {
    this.leave("closed");
    this.#bodies?.dispose();
    this.#bodies = null;
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
    if (state.recording) {
      this.#reportGoals(tracked);
      const seen = this.#isFrozen ? this.#freezable : shown;
      this.#recorder.frame(timeS, seen, phases.phaseId, phases.run?.clockRuns ?? false);
    }
    const goesOn = telemetry.status.connected || telemetry.welcome.on_disconnect === "continue";
    const { run } = phases;
    // The newest frame may have been computed before the boxes of this phase were there.
    phases.frame(timeS, shown.touched.length === this.#touchCount ? shown : null, goesOn);
    if (run !== null) this.#recorder.setActive(run.activeS(timeS));
  }

  /** Bring the headset in line with the session's state. */
  #follow(state: HeadsetState, tracked: TrackedFrame): void {
    if (state.materialised) this.#hasReportedBody = true;
    if (state.materialised && this.#bodies === null) this.#prepare(state);
    if (state.step_kind === "materialise" && !this.#hasReportedBody) {
      this.#materialise(state, tracked);
    }
    if (this.#bodies === null) return;
    this.#changeAvatar(state);
    this.#phases.follow(state, this.#parts.telemetry.settled, this.#timeS);
  }

  /** The participant stands in the figure and presses both grips: the body appears. */
  #materialise(state: HeadsetState, { hands }: TrackedFrame): void {
    if (this.#bodies === null) this.#prepare(state);
    const isAsked = hands.left.isSqueezing && hands.right.isSqueezing;
    if (!isAsked || !this.#hasMoved) return;
    this.#hasReportedBody = true;
    this.#report([{ kind: "materialised", t_s: this.#timeS }]);
  }

  /**
   * Request every body of the study at once: they are ready when a block begins, and neither the
   * time nor the kind of a request reveals which is worn next.
   */
  #prepare(state: HeadsetState): void {
    if (this.#isPreparing) return;
    this.#isPreparing = true;
    const { telemetry, calibrator, prepareBodies, onFailure } = this.#parts;
    const statureM = state.participant.stature_m ?? calibrator.statureM ?? USUAL_STATURE_M;
    prepareBodies(statureM, telemetry.welcome.bodies ?? []).then((bodies) => {
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

  #leavePhase(): void {
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
    return state.step_kind === "materialise" ? "stepping_in" : "standby";
  }
}

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

const placesOf = (parts: TrackedFrame["parts"]): Goals => ({
  Hips: parts.Hips.place,
  Head: parts.Head.place,
  LeftHand: parts.LeftHand.place,
  RightHand: parts.RightHand.place,
  LeftLowerLeg: parts.LeftLowerLeg.place,
  RightLowerLeg: parts.RightLowerLeg.place,
});
