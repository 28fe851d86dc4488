/** What the participant sees in each place of the visit: the world, told what is to be seen. */
import type { Limb, TimedRun } from "../tasks";
import { BoxRun, currentGoal, displayedNumbers, surfaceColours } from "../tasks";
import type { TrackedFrame } from "../tracking/tracked";
import type { Device, TaskShown, Visible, World } from "../world";
import type { Place, Scenery, View } from "./ports";

const NO_SETUPS: readonly Limb[] = [];
const NO_DEVICES: readonly Device[] = [];

export class WorldScenery implements Scenery {
  readonly #world: World;
  readonly #limbs: readonly Limb[];
  #task: TaskShown | null = null;
  #shownState: unknown = null;

  /** `limbs`: those that the study has tasks for. */
  constructor(world: World, limbs: readonly Limb[]) {
    this.#world = world;
    this.#limbs = limbs;
  }

  show(view: View): void {
    const { timeS, place, tracked, bodies, run } = view;
    const isTask = run instanceof BoxRun;
    this.#world.show({
      timeS,
      eyes: tracked.eyes,
      bodies,
      visible: this.#visible(place, run, bodies !== null),
      devices: place === "acting" ? NO_DEVICES : devicesOf(tracked),
      task: isTask ? this.#taskOf(run) : null,
      remainingS: run === null ? null : remainingS(run, timeS),
      completed: isTask ? run.completed : null,
      isFrozen: view.isFrozen,
      isCurtainDrawn: view.isCurtainDrawn,
    });
  }

  #visible(place: Place, run: TimedRun | null, hasBodies: boolean): Visible {
    const isActing = place === "acting" && hasBodies;
    return {
      local: false,
      remote: isActing,
      figure: place === "stepping_in",
      devices: !isActing,
      setups: isActing ? this.#setups(run) : NO_SETUPS,
    };
  }

  /** The boxes of the task; both in free movement, so that people get to know them. */
  #setups(run: TimedRun | null): readonly Limb[] {
    if (run === null) return NO_SETUPS;
    const { limb } = run.order;
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

function devicesOf({ parts, hands }: TrackedFrame): readonly Device[] {
  const devices: Device[] = [];
  for (const [part, { place }] of Object.entries(parts)) {
    if (place === null || part === "Head") continue;
    const hand = part === "LeftHand" ? hands.left : part === "RightHand" ? hands.right : null;
    const kind = hand === null ? "tracker" : hand.holdsController ? "controller" : "hand";
    devices.push({ kind, place });
  }
  return devices;
}
