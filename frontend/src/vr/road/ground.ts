/**
 * How high the ground of the study's road is, and how it carries a body that walks over its kerbs.
 *
 * The lab's floor is flat, so nobody is lifted: the street sinks and rises under the participant, by
 * the height of the ground below the hips, and each foot is set on the ground where it is. That is
 * the rule of the moving ground of `app/science/retargeting/ground.py` (Degen et al. 2022), seen from
 * the body instead of from the street. `app/rehearsal/road_shape.py` has the same, and the vectors in
 * `tests/vectors/road` hold both to it.
 */
import { JOINTS, UNIT_SKELETON } from "@shared/avatar/anatomy.generated";
import type { Goals } from "@shared/avatar/goals";
import type { Place } from "@shared/avatar/hips";
import { rotate, type Vector } from "@shared/rotations";
import type { Road } from "../telemetry";

/** Over this far before and behind a kerb's edge the street sinks with the hips, metres. */
const HIPS_REACH_M = 0.35;
/** And so far a foot is led over it, so that neither heel nor toes stick in it. */
const FOOT_REACH_M = 0.12;
/** From the knee to the ankle, of somebody 1 m tall. */
const UNIT_SHANK_M = Math.hypot(
  ...UNIT_SKELETON.offsets.slice(
    3 * JOINTS.indexOf("LeftFoot"),
    3 * JOINTS.indexOf("LeftFoot") + 3,
  ),
);

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

  /** How far a foot with its ankle there is set above the lab's floor. */
  liftM(ankleZM: number, hipsZM: number): number {
    return this.heightM(ankleZM, FOOT_REACH_M) - this.sunkM(hipsZM);
  }

  /**
   * The goals of somebody of this stature with each foot on the ground where it is; hips, head and
   * hands stay.
   */
  carried(goals: Goals, hipsZM: number, statureM: number): Goals {
    const shank: Vector = [0, -UNIT_SHANK_M * statureM, 0];
    const onGround = (knee: Place | null): Place | null => {
      if (knee === null) return null;
      const [x, y, z] = knee.positionM;
      const ankleZM = z + rotate(knee.rotation, shank)[2];
      return { ...knee, positionM: [x, y + this.liftM(ankleZM, hipsZM), z] };
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
