/** Which joints of the product's body are which part of it, by their HumanBodyBones names. */
import type { BodyRoles } from "@shared/stage/figure";

export function rolesOf(joints: readonly string[]): BodyRoles {
  const of = (name: string): number | null => {
    const at = joints.indexOf(name);
    return at < 0 ? null : at;
  };
  const side = (name: "Left" | "Right"): ReadonlySet<number> =>
    new Set(joints.flatMap((joint, at) => (joint.startsWith(name) ? [at] : [])));
  return {
    head: of("Head"),
    leftHip: of("LeftUpperLeg"),
    rightHip: of("RightUpperLeg"),
    left: side("Left"),
    right: side("Right"),
  };
}
