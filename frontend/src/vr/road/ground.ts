/**
 * How high the ground of the study's road is, and how it carries a body that walks over its kerbs.
 *
 * The lab's floor is flat, so nobody is lifted: the street sinks and rises under the participant, by
 * the height of the ground below the hips, and each foot is set on the ground where it is. That is
 * the rule of the moving ground of `app/science/retargeting/ground.py` (Degen et al. 2022), seen from
 * the body instead of from the street.
 */
import type { Goals } from "@shared/avatar/goals";
import type { Place } from "@shared/avatar/hips";
import type { Road } from "../telemetry";

/** Over this far before and behind a kerb's edge the street sinks with the hips, metres. */
const HIPS_REACH_M = 0.35;
/** And so far a foot is led over it, so that neither heel nor toes stick in it. */
const FOOT_REACH_M = 0.12;

export class RoadGround {
  readonly #kerbM: number;
  readonly #nearZM: number;
  readonly #farZM: number;

  constructor({ road, kerb_height_m, starts_behind_kerb_m }: Road) {
    this.#kerbM = kerb_height_m;
    this.#nearZM = -starts_behind_kerb_m;
    this.#farZM = this.#nearZM - 2 * road.lane_width_m;
  }

  /** Where the kerbs' edges are in the room, z, the near one first. */
  get kerbsZM(): readonly [near: number, far: number] {
    return [this.#nearZM, this.#farZM];
  }

  /** The height of the ground above the carriageway, led softly over the kerbs' edges. */
  heightM(zM: number, reachM: number): number {
    const onPavement = Math.max(zM - this.#nearZM, this.#farZM - zM);
    return this.#kerbM * smooth(onPavement / (2 * reachM) + 0.5);
  }

  /** How far the street has sunk under somebody whose hips are there. */
  sunkM(hipsZM: number): number {
    return this.heightM(hipsZM, HIPS_REACH_M);
  }

  /** The goals with each foot on the ground where it is; hips, head and hands stay. */
  carried(goals: Goals, hipsZM: number): Goals {
    const sunkM = this.sunkM(hipsZM);
    const onGround = (place: Place | null): Place | null => {
      if (place === null) return null;
      const [x, y, z] = place.positionM;
      const liftM = this.heightM(z, FOOT_REACH_M) - sunkM;
      return { ...place, positionM: [x, y + liftM, z] };
    };
    return {
      ...goals,
      LeftLowerLeg: onGround(goals.LeftLowerLeg),
      RightLowerLeg: onGround(goals.RightLowerLeg),
    };
  }
}

/** From 0 to 1 without a kink at either end. */
function smooth(share: number): number {
  const s = Math.min(1, Math.max(0, share));
  return s * s * (3 - 2 * s);
}
