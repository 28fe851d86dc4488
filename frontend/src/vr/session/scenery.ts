/** What the participant sees in each place of the visit: the world, told what is to be seen. */

import type { CompanionLink } from "../companion";
import type { Limb, TimedRun } from "../tasks";
import { BoxRun, currentGoal, displayedNumbers, RoadRun, surfaceColours } from "../tasks";
import type { TrackedFrame, TrackingDevice } from "../tracking/tracked";
import type { Device, TaskShown, Visible, World } from "../world";
import type { Scenery, View } from "./ports";

type Companion = Pick<CompanionLink, "isInTasks" | "look">;
const NO_SETUPS: readonly Limb[] = [];
const NO_DEVICES: readonly Device[] = [];

export class WorldScenery implements Scenery {
  readonly #world: World;
  readonly #limbs: readonly Limb[];
  readonly #companion: () => Companion | null;
  #seen: ArrayLike<number> | null = null;
  #task: TaskShown | null = null;
  #shownState: unknown = null;

  /** `limbs`: those that the study has tasks for; `companion`: null where there is no socket. */
  constructor(world: World, limbs: readonly Limb[], companion: () => Companion | null) {
    this.#world = world;
    this.#limbs = limbs;
    this.#companion = companion;
  }

  show(view: View): void {
    const { timeS, place, tracked, bodies, run } = view;
    const isTask = run instanceof BoxRun;
    const visible = this.#visible(view);
    const { stature_m: statedM } = view.state.participant;
    // Nothing is measured yet: the figure has the stature that was stated.
    if (visible.figure && place !== "stepping_in" && bodies === null && statedM !== null) {
      this.#world.wear(null, statedM);
    }
    this.#world.show({
      timeS,
      eyes: tracked.eyes,
      bodies,
      visible,
      devices: place === "acting" ? NO_DEVICES : devicesOf(tracked),
      task: isTask ? this.#taskOf(run) : null,
      street: view.street,
      companion: this.#companionIn(view),
      remainingS: run === null ? null : remainingS(run, timeS),
      completed: isTask ? run.completed : null,
      isFrozen: view.isFrozen,
      isCurtainDrawn: view.cover !== "none",
      isCurtainAtOnce: view.cover === "cut",
    });
  }

  #visible({ place, run, bodies, calibration, state }: View): Visible {
    const isActing = place === "acting" && bodies !== null;
    return {
      // In free movement people compare their own body with the one that they act with. In the
      // mirror check before stepping in they see what the tracking says, not the study's avatar.
      local:
        (isActing && run?.order.limb === null && !(run instanceof RoadRun)) ||
        (place === "calibrating" && calibration?.step === "mirror" && bodies !== null),
      remote: isActing,
      // Where the figure stands one is asked to stand before the measuring poses, too; and it is
      // what the height is compared with.
      figure:
        place === "stepping_in" ||
        (place === "calibrating" && calibration?.step === "square") ||
        (place === "standby" && state.step_kind === "height"),
      devices: !isActing,
      setups: isActing ? this.#setups(run) : NO_SETUPS,
    };
  }

  /**
   * Where the participant looks at their own body and nothing is asked of it: between tasks and in
   * free movement. A task looks as it does for everybody else, unless the experimenter wants it
   * otherwise; on the road there is another world.
   */
  #companionIn({ place, run, bodies, street, calibration, cover }: View): ArrayLike<number> | null {
    const companion = this.#companion();
    if (companion === null) return null;
    const isInRoom = place === "acting" && bodies !== null && street === null;
    const isFree = isInRoom && calibration === null && cover === "none";
    const pose = companion.look(isFree && (!(run instanceof BoxRun) || companion.isInTasks));
    // The curtain that closes hides whoever was there.
    this.#seen = pose ?? (cover === "fade" && isInRoom ? this.#seen : null);
    return this.#seen;
  }

  /** The boxes of the task; both in free movement, so that people get to know them. */
  #setups(run: TimedRun | null): readonly Limb[] {
    if (run === null) return NO_SETUPS;
    const { limb } = run.order;
    if (run instanceof RoadRun) return NO_SETUPS;
    return limb === null ? this.#limbs : this.#limbs.filter((one) => one === limb);
  }

  /** The task as it is shown; made anew only when its state has changed. */
  #taskOf(run: BoxRun): TaskShown {
    const { state } = run;
    if (this.#task === null || this.#shownState !== state) {
      this.#shownState = state;
      this.#task = {
        limb: state.rules.layout.limb,
        goal: currentGoal(state),
        colours: surfaceColours(state),
        numbers: displayedNumbers(state),
      };
    }
    return this.#task;
  }
}

/** Active time that is left; the whole time during the preparation. */
function remainingS(run: TimedRun, timeS: number): number {
  return Math.max(0, run.order.duration_s - run.activeS(timeS));
}

/** What is drawn for what tracks a part; joints of a body look like trackers. */
const LOOKS: Partial<Record<TrackingDevice, Device["kind"]>> = {
  controller: "controller",
  hand: "hand",
};

function devicesOf({ parts }: TrackedFrame): readonly Device[] {
  const devices: Device[] = [];
  for (const [part, { place, device }] of Object.entries(parts)) {
    if (place === null || device === null || part === "Head") continue;
    devices.push({ kind: LOOKS[device] ?? "tracker", place });
  }
  return devices;
}
