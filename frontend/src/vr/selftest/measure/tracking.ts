/** How well the goals of the body are known over time, and how often their poses change. */
import { GOAL_PARTS } from "@shared/avatar/goals";
import type { Place } from "@shared/avatar/hips";
import type { GoalPart, GoalState, TrackedFrame } from "../../tracking/tracked";
import type { Report } from "../report";

type GoalFigures = Report["tracking"][GoalPart];

/** What is known of one goal so far. */
class GoalRecord {
  readonly #stateS: Record<GoalState, number> = { tracked: 0, inferred: 0, lost: 0 };
  #longestLossS = 0;
  #lossS = 0;
  #changes = 0;
  #pose: Place | null = null;
  #state: GoalState | null = null;

  /** The time since the frame before counts for the state in which this one finds the goal. */
  note(state: GoalState, place: Place | null, sinceS: number): void {
    this.#state = state;
    this.#stateS[state] += sinceS;
    this.#lossS = state === "lost" ? this.#lossS + sinceS : 0;
    this.#longestLossS = Math.max(this.#longestLossS, this.#lossS);
    if (place !== null && this.#pose !== null && !areEqual(place, this.#pose)) this.#changes += 1;
    if (place !== null) this.#pose = place;
  }

  figures(durationS: number): GoalFigures {
    if (durationS <= 0) {
      const share = (state: GoalState) => Number((this.#state ?? "lost") === state);
      const shares = {
        tracked: share("tracked"),
        inferred: share("inferred"),
        lost: share("lost"),
      };
      return { ...shares, longest_loss_s: 0, pose_rate_hz: 0 };
    }
    const { tracked, inferred, lost } = this.#stateS;
    // Not the duration, from which the sum differs by rounding: a share is never more than 1.
    const wholeS = tracked + inferred + lost;
    return {
      tracked: tracked / wholeS,
      inferred: inferred / wholeS,
      lost: lost / wholeS,
      longest_loss_s: this.#longestLossS,
      pose_rate_hz: this.#changes / durationS,
    };
  }
}

export class TrackingRecord {
  readonly #goals = new Map(GOAL_PARTS.map((part) => [part, new GoalRecord()]));
  #firstS: number | null = null;
  #lastS = 0;

  /** Note what the devices reported in a frame. */
  note({ timeS, parts }: Pick<TrackedFrame, "timeS" | "parts">): void {
    const sinceS = this.#firstS === null ? 0 : timeS - this.#lastS;
    this.#firstS ??= timeS;
    this.#lastS = timeS;
    for (const [part, record] of this.#goals) {
      const { state, place } = parts[part];
      record.note(state, place, sinceS);
    }
  }

  figures(): Report["tracking"] {
    const durationS = this.#firstS === null ? 0 : this.#lastS - this.#firstS;
    const named = [...this.#goals].map(([part, record]) => [part, record.figures(durationS)]);
    return Object.fromEntries(named) as Report["tracking"];
  }
}

/** Whether two poses are the same to the last bit: a measured one never stays so. */
function areEqual(one: Place, other: Place): boolean {
  return (
    one.positionM.every((value, at) => value === other.positionM[at]) &&
    one.rotation.every((value, at) => value === other.rotation[at])
  );
}
