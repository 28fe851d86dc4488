/**
 * The panels of a visit: what the participant reads, answers and is warned of beside the scene, and
 * how they stop.
 *
 * The session's state decides what is shown (`wanted.ts`); the loop calls `follow` once a frame and
 * goes on recording whatever is shown. A form is kept open while something more urgent covers it,
 * and its answers are on the device before anything else happens to them.
 */
import { deliver } from "@shared/forms/deliver";
import { openForms, StoredForms } from "@shared/forms/storedForms";
import type { CalibrationPrompt } from "../../calibration";
import {
  hasSpoken,
  looksRaised,
  type PanelContent,
  Panels,
  PauseRoom,
  panelWords,
  StillContent,
  StopGesture,
  StopRing,
} from "../../panels";
import { BoxRun, RoadRun, type TaskLayout, type TimedRun } from "../../tasks";
import type { HeadsetState, TelemetryClient } from "../../telemetry";
import type { TrackedFrame } from "../../tracking/tracked";
import { type BoundaryProblem, edgeDistanceM, type FloorPoint, type World } from "../../world";
import type { Cover, Place } from "../ports";
import { CalibrationPanel } from "./calibrationPanel";
import { Contents } from "./contents";
import { type Desk, HEADSET_FORMS } from "./desk";
import { type Situation, type Wanted, wanted } from "./wanted";

export interface VisitPanelsParts {
  readonly telemetry: Pick<TelemetryClient, "welcome" | "settled" | "status">;
  readonly world: World;
  readonly desk: Desk;
  /** The participant wants to stop, or asks for the experimenter. */
  readonly onCall: (what: "stop" | "help") => void;
  /** A button of the calibration's panel was pressed. */
  readonly onCalibration: (target: string) => void;
  /** Something on a panel was pressed with this hand: for a pulse of its controller. */
  readonly onPressed?: (side: "left" | "right" | null) => void;
  /** False on a screen, which nobody can take off. */
  readonly isWorn: () => boolean;
  /** Whether the wearer has to look around, so that the lab's trackers are aligned. */
  readonly looksAround?: () => boolean;
}

/** One frame, as the loop knows it. */
export interface Moment {
  readonly timeS: number;
  readonly place: Place;
  readonly state: HeadsetState;
  readonly tracked: TrackedFrame;
  readonly run: TimedRun | null;
  /** The calibration that is under way; null otherwise. */
  readonly calibration: CalibrationPrompt | null;
}

/** Somebody has stopped, and nobody has come yet. */
interface Stop {
  readonly sinceS: number;
  /** The server has the call. */
  isTold: boolean;
  /** The state has said so. */
  wasCalled: boolean;
}

const OFFLINE_AFTER_S = 1.5;
/** Somebody who has stopped is told to call out loud when nobody was told for so long. */
const UNTOLD_AFTER_S = 5;
/** A report that was made just now may not be counted among those to be stored yet. */
const STORED_AFTER_S = 0.5;
/** Feet that are not seen for a moment do not forbid a task. */
const FEET_LOST_S = 1;
/** The warning begins and ends at these distances from the edge, metres. */
const EDGE_M = { begins: 0.3, ends: 0.45 } as const;
/** The room is hidden for this long where it changes from one frame to the next. */
const CUT_S = 0.12;
/** Before the end of a freeze, when the body jumps to where the participant is. */
const FADE_BEFORE_S = 0.25;

export class VisitPanels {
  readonly #parts: VisitPanelsParts;
  readonly #panels: Panels;
  readonly #pauseRoom = new PauseRoom();
  readonly #gesture = new StopGesture();
  readonly #store = new StoredForms(openForms(HEADSET_FORMS));
  /** The upper end of the boxes. */
  readonly #highestM = new WeakMap<TaskLayout, number>();
  #ring: StopRing | null = null;
  readonly #contents: Contents;
  #language = "";
  /** What the last choice was made from, and what it was. */
  readonly #inputs: unknown[] = new Array(14).fill(undefined);
  #wanted: Wanted = { kind: "nothing" };
  #shown = "";
  #content: PanelContent | null = null;
  /** It goes before everything but a stop. */
  #calibration: CalibrationPanel | null = null;
  #stop: Stop | null = null;
  #offlineSinceS: number | null = null;
  #feetSeenS = Number.NEGATIVE_INFINITY;
  #isNearEdge = false;
  #bounds: readonly FloorPoint[] | null = null;
  #boundary: BoundaryProblem = null;
  #isSpaceAccepted = false;
  #cutUntilS = Number.NEGATIVE_INFINITY;
  #isCutAsked = false;
  #hasCrossed = false;
  #body: string | null = null;
  #wasActing: boolean | null = null;

  constructor(parts: VisitPanelsParts) {
    this.#parts = parts;
    const { world, onPressed } = parts;
    const tooLong = panelWords(parts.telemetry.welcome.language)("form.tooLong");
    this.#panels = new Panels({ wallZM: world.mirror.planeZM, tooLong });
    this.#panels.onPressed = (side) => {
      world.sounds.play("press");
      onPressed?.(side);
    };
    this.#contents = new Contents({
      ...parts,
      store: this.#store,
      measure: this.#panels.measure,
      sizesOfSpace: () => world.sizesOf(this.#bounds),
      onSpaceAccepted: () => {
        this.#boundary = null;
        this.#isSpaceAccepted = true;
        world.hideBoundary();
      },
    });
    world.panels.add(this.#pauseRoom.object, this.#panels.object);
    void this.#sendWaiting().catch(() => undefined);
  }

  /** Send what an earlier page of this session could not send, and forget what is long over. */
  async #sendWaiting(): Promise<void> {
    const { desk, telemetry, onCall } = this.#parts;
    await this.#store.forgetOld(new Date());
    for (const { id, queued, draft } of await this.#store.waiting(telemetry.welcome.session_id)) {
      if (queued === null) continue;
      const { kind } = await deliver(this.#store, id, queued, (answers) => desk.submit(answers));
      if (kind === "stored" && hasSpoken(draft, queued)) onCall("help");
    }
  }

  /** What is shown now, and what can be pressed, for tests. */
  get seen() {
    const screen = (this.#calibration ?? this.#content)?.screen ?? null;
    return { wanted: this.#wanted, screen };
  }

  /** Where what can be pressed is in the room, for tests that point at it. */
  get targetsM() {
    return this.#panels.targetsM;
  }

  /**
   * The guarded space as the device gives it, in the world; null where the device guards none.
   * `isNew`: the session has just begun, so that what is missing is said.
   */
  guard(bounds: readonly FloorPoint[] | null, isNew: boolean): void {
    this.#bounds = bounds;
    if (isNew) this.#boundary = this.#parts.world.checkBoundary(bounds);
  }

  /** The room changes with the next frame: hide it until it is there. */
  cut(): void {
    this.#isCutAsked = true;
  }

  /** Let the panel stand in front of the wearer again. */
  /** The study is shown in a window; `halfViewRad`: from its middle to its edge. */
  fitWindow(halfViewRad: number): void {
    this.#panels.halfViewRad = halfViewRad;
  }

  recentre(): void {
    this.#panels.recentre();
  }

  /** One frame: choose and draw the panel, look for a stop. Returns how the room is hidden. */
  follow(moment: Moment): Cover {
    const { timeS, tracked, state } = moment;
    this.#speak(state);
    const isStopping = this.#lookForStop(moment);
    this.#followConnection(timeS);
    this.#followFeet(tracked);
    this.#followEdge(tracked);
    this.#choose(moment);
    this.#followCalibration(moment);
    const calibration = this.#stop === null ? this.#calibration : null;
    this.#panels.show(calibration ?? this.#content);
    this.#panels.update(tracked, !isStopping);
    const isPaused = this.#wanted.kind === "pause" && calibration === null;
    this.#pauseRoom.show(timeS, isPaused);
    return this.#cover(moment, isPaused);
  }

  dispose(): void {
    this.#contents.dispose();
    this.#panels.dispose();
    this.#pauseRoom.dispose();
    this.#ring?.dispose();
    void this.#store.close().catch(() => undefined);
  }

  /** Follow the participant's language. */
  #speak({ panel }: HeadsetState): void {
    const language = panel?.language ?? this.#parts.telemetry.welcome.language;
    if (language === this.#language) return;
    this.#language = language;
    this.#contents.speak(language);
    this.#parts.world.speak(language);
    this.#shown = "";
    if (this.#ring !== null) this.#parts.world.panels.remove(this.#ring.object);
    this.#ring?.dispose();
    this.#ring = new StopRing(this.#contents.words);
    this.#parts.world.panels.add(this.#ring.object);
  }

  /** Returns whether a stop is on its way. */
  #lookForStop({ timeS, tracked, place, run, state }: Moment): boolean {
    // Both grips are how the body is entered, which happens in the frame that they are pressed in;
    // after the end nothing is left to be stopped.
    const isEntering = place === "stepping_in" || (place === "acting" && this.#wasActing === false);
    const isOff = isEntering || place === "over" || this.#stop !== null;
    const progress = this.#gesture.update(tracked, {
      isOff,
      needsBothHands: this.#reachesHigh(run, tracked),
    });
    this.#ring?.update(tracked, progress?.share === 1 ? null : progress);
    if (progress?.share === 1) {
      this.#stop = { sinceS: timeS, isTold: false, wasCalled: false };
      this.#parts.onCall("stop");
      return false;
    }
    const stop = this.#stop;
    if (stop === null || !this.#parts.telemetry.settled) return progress !== null;
    // An older server says nothing of calls: what is stored was told.
    const called = state.panel?.called ?? timeS - stop.sinceS > STORED_AFTER_S;
    if (called) stop.isTold = true;
    if (called && state.panel !== undefined) stop.wasCalled = true;
    // Somebody came, or the phase was resumed.
    if ((stop.wasCalled && !called) || run?.clockRuns === true) this.#stop = null;
    return false;
  }

  /** Whether the task that runs makes people raise their hands as high as a stop does. */
  #reachesHigh(run: TimedRun | null, { eyes }: TrackedFrame): boolean {
    if (!(run instanceof BoxRun) || eyes === null) return false;
    const { layout } = run.state.rules;
    let highestM = this.#highestM.get(layout);
    if (highestM === undefined) {
      const { surfaces } = layout;
      highestM = Math.max(...surfaces.map(({ centerM, halfSizeM }) => centerM[1] + halfSizeM[1]));
      this.#highestM.set(layout, highestM);
    }
    return looksRaised(highestM, eyes.positionM[1]);
  }

  #followConnection(timeS: number): void {
    if (this.#parts.telemetry.status.connected) this.#offlineSinceS = null;
    else this.#offlineSinceS ??= timeS;
  }

  #followFeet({ parts, timeS }: TrackedFrame): void {
    const { LeftLowerLeg: left, RightLowerLeg: right } = parts;
    if (left.state === "tracked" && right.state === "tracked") this.#feetSeenS = timeS;
  }

  #followCalibration({ calibration }: Moment): void {
    const { words } = this.#contents;
    if (calibration === null) this.#calibration = null;
    else if (this.#calibration !== null) this.#calibration.follow(words, calibration);
    else {
      const { onCalibration } = this.#parts;
      this.#calibration = new CalibrationPanel(words, calibration, onCalibration);
    }
  }

  #followEdge({ eyes }: TrackedFrame): void {
    const isKnown = this.#bounds !== null && this.#bounds.length >= 3;
    if (!isKnown || this.#bounds === null || this.#isSpaceAccepted || eyes === null) {
      this.#isNearEdge = false;
      return;
    }
    const [x, , z] = eyes.positionM;
    const distanceM = edgeDistanceM({ x, z }, this.#bounds);
    this.#isNearEdge = distanceM < (this.#isNearEdge ? EDGE_M.ends : EDGE_M.begins);
  }

  /** Choose the panel anew, if anything that it depends on has changed. */
  #choose({ timeS, place, state, run, tracked }: Moment): void {
    // The words for the way back praise a crossing; before the first one there is nothing to praise.
    this.#hasCrossed ||= run instanceof RoadRun && (run.clockRuns || run.completed > 0);
    const phase = phaseOf(run, timeS, this.#hasCrossed);
    const leftS = run?.awaits === "traffic" ? null : (run?.preparationLeftS(timeS) ?? 0);
    const secondsLeft = phase === "preparing" ? leftS && Math.ceil(leftS) : 0;
    const stop = this.#stopState(timeS);
    const isOffline = this.#offlineSinceS !== null && timeS - this.#offlineSinceS > OFFLINE_AFTER_S;
    const areFeetTracked = timeS - this.#feetSeenS < FEET_LOST_S;
    const { holdsController } = tracked.hands.right;
    const inputs = this.#inputs;
    let isChanged = false;
    const note = (at: number, value: unknown) => {
      isChanged ||= inputs[at] !== value;
      inputs[at] = value;
    };
    note(0, state);
    note(1, place);
    note(2, phase);
    note(3, secondsLeft);
    note(4, stop);
    note(5, isOffline);
    note(6, areFeetTracked);
    note(7, this.#isNearEdge);
    note(8, this.#boundary);
    note(9, this.#language);
    note(10, holdsController);
    note(11, this.#contents.read);
    note(12, this.#shown);
    const looksAround = this.#parts.looksAround?.() ?? false;
    note(13, looksAround);
    if (!isChanged) return;
    const situation: Situation = {
      place,
      order: state.panel ?? null,
      stepKind: state.step_kind,
      stepIndex: state.step_index,
      phase,
      areFeetTracked,
      looksAround,
      secondsLeft,
      stop,
      isOffline,
      isNearEdge: this.#isNearEdge,
      boundary: this.#boundary,
    };
    this.#become(wanted(situation), state, holdsController, timeS);
    inputs[12] = this.#shown;
  }

  #stopState(timeS: number): Situation["stop"] {
    const stop = this.#stop;
    if (stop === null) return null;
    if (stop.isTold) return "told";
    return timeS - stop.sinceS > UNTOLD_AFTER_S ? "untold" : "telling";
  }

  #become(next: Wanted, state: HeadsetState, holdsController: boolean, timeS: number): void {
    this.#contents.keepForm(state.panel?.form ?? null);
    const title = state.panel?.title ?? null;
    const text = state.panel?.text ?? null;
    const screenTexts = state.panel?.screen_texts ?? {};
    const shown = JSON.stringify([next, title, text, holdsController, this.#contents.read]);
    if (shown === this.#shown) return;
    const wasForm = this.#wanted.kind === "form";
    this.#shown = shown;
    this.#wanted = next;
    const content = this.#contents.of(next, { title, text, screenTexts, holdsController });
    if (next.kind === "form" && !wasForm) this.#contents.formShownAgain(timeS * 1000);
    // The same kind of screen with another number changes in place.
    const before = this.#content;
    if (before instanceof StillContent && content instanceof StillContent) {
      if (before.screen.key === content.screen.key && (content.screen.buttons ?? []).length === 0) {
        before.screen = content.screen;
        return;
      }
    }
    this.#content = content;
  }

  #cover({ timeS, place, state, run }: Moment, isPaused: boolean): Cover {
    // Between phases the participant stays in the body; an order without a name means the usual one.
    const body = state.phase === null ? this.#body : (state.phase.body ?? null);
    const isActing = place === "acting";
    // The first frame of a visit changes nothing that was seen before.
    const isChanged =
      this.#wasActing !== null && (body !== this.#body || (isActing && !this.#wasActing));
    this.#body = body;
    this.#wasActing = isActing;
    if (isChanged || this.#isCutAsked) this.#cutUntilS = timeS + CUT_S;
    this.#isCutAsked = false;
    if (timeS < this.#cutUntilS) return "cut";
    const freezeLeftS = run?.freezeLeftS(timeS) ?? null;
    const isThawing = freezeLeftS !== null && freezeLeftS < FADE_BEFORE_S;
    return isPaused || isThawing ? "fade" : "none";
  }
}

/** Where a phase is; `hasCrossed`: the wearer was on the road before. */
export function phaseOf(
  run: TimedRun | null,
  timeS: number,
  hasCrossed: boolean,
): Situation["phase"] {
  if (run === null) return null;
  if (run.isPaused) return "paused";
  if (run.isFrozen) return "frozen";
  if (run.preparationLeftS(timeS) !== null) {
    if (run.awaits !== "start") return "preparing";
    return hasCrossed ? "walk_back" : "to_start";
  }
  return run instanceof BoxRun && run.state.walkBackSinceS !== null ? "walk_back" : "running";
}
