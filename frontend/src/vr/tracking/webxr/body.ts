/**
 * WebXR's body tracking: a draft of the Immersive Web Community Group (immersive-web/body-tracking),
 * which three does not know.
 *
 * `frame.body` is an iterable of names and spaces, null while no body is seen. Neither its size nor
 * any joint may be relied on: Quest's has 84 joints where the draft lists 83. The rest pose of the
 * joints is the maker's own, so their rotations mean nothing until they are bound to the T-pose of
 * the calibration; a start pose taken for the rest pose would turn limbs for the whole session.
 */
import type { Place } from "@shared/avatar/hips";
import { placeOf } from "../places";
import type { GoalPart } from "../tracked";

/** The draft's joints that stand for our goals; the shins' joints are at the knees. */
export const BODY_JOINTS = {
  Hips: "hips",
  Head: "head",
  LeftHand: "left-hand-wrist",
  RightHand: "right-hand-wrist",
  LeftLowerLeg: "left-lower-leg",
  RightLowerLeg: "right-lower-leg",
} as const satisfies Readonly<Record<GoalPart, string>>;

const PART_OF: ReadonlyMap<string, GoalPart> = new Map(
  (Object.entries(BODY_JOINTS) as [GoalPart, string][]).map(([part, joint]) => [joint, part]),
);

interface FrameWithBody {
  readonly body?: Iterable<readonly [string, XRSpace]> | null;
}

/** The places of the goals that the browser's body tracking knows in one frame. */
export class BodyReader {
  private readonly places = new Map<GoalPart, Place>();

  /** Read the frame; false while no body is seen. */
  read(frame: XRFrame, space: XRReferenceSpace): boolean {
    this.places.clear();
    const body = (frame as unknown as FrameWithBody).body ?? null;
    if (body === null) return false;
    for (const [name, joint] of body) {
      const part = PART_OF.get(name);
      if (part === undefined) continue;
      const pose = frame.getPose(joint, space);
      if (pose !== undefined && pose !== null) this.places.set(part, placeOf(pose.transform));
    }
    return this.places.size > 0;
  }

  place(part: GoalPart): Place | null {
    return this.places.get(part) ?? null;
  }
}
