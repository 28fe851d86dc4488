/**
 * The 22 joints of a human body (Unity's HumanBodyBones), their groups, and where they are on a
 * drawing.
 */
import { BODY } from "@shared/bodyJoints";
import type { BodyRoles } from "@shared/stage/figure";

export type Group = "trunk" | "leftArm" | "rightArm" | "leftLeg" | "rightLeg";

const arm = (side: string) => ["Shoulder", "UpperArm", "LowerArm", "Hand"].map((j) => side + j);
const leg = (side: string) => ["UpperLeg", "LowerLeg", "Foot", "Toes"].map((j) => side + j);

export const GROUPS: Readonly<Record<Group, readonly string[]>> = {
  trunk: ["Hips", "Spine", "Chest", "UpperChest", "Neck", "Head"],
  leftArm: arm("Left"),
  rightArm: arm("Right"),
  leftLeg: leg("Left"),
  rightLeg: leg("Right"),
};

/** Seen from the front, so the body's left is on the right; a unit is a hundredth of its height. */
const CENTRE: Readonly<Record<string, readonly [number, number]>> = {
  Hips: [0, 45],
  Spine: [0, 39],
  Chest: [0, 32],
  UpperChest: [0, 25],
  Neck: [0, 16],
  Head: [0, 9],
};
const LEFT: Readonly<Record<string, readonly [number, number]>> = {
  Shoulder: [5, 19],
  UpperArm: [13, 20],
  LowerArm: [19, 34],
  Hand: [23, 47],
  UpperLeg: [6, 49],
  LowerLeg: [8, 71],
  Foot: [9, 92],
  Toes: [14, 97],
};

/** The position of a body joint on the small drawing. */
export function placeOnBody(joint: string): readonly [x: number, y: number] {
  const centre = CENTRE[joint];
  if (centre !== undefined) return centre;
  const isLeft = joint.startsWith("Left");
  const [x, y] = LEFT[joint.replace(/^(Left|Right)/, "")] ?? [0, 0];
  return [isLeft ? x : -x, y];
}

/** Which joints of a skeleton are which part of the body, so that a stage can distinguish them. */
export function rolesFrom(
  joints: readonly string[],
  map: Readonly<Record<string, string>>,
): BodyRoles {
  const place = (bodyJoint: string): number | null => {
    const at = joints.indexOf(map[bodyJoint] ?? "");
    return at < 0 ? null : at;
  };
  const side = (name: string) =>
    new Set(
      Object.keys(map)
        .filter((joint) => joint.startsWith(name))
        .flatMap((joint) => place(joint) ?? []),
    );
  return {
    head: place("Head"),
    leftHip: place("LeftUpperLeg"),
    rightHip: place("RightUpperLeg"),
    left: side("Left"),
    right: side("Right"),
  };
}

/** The joint map of an avatar, whose joints are the body's own. */
export const AVATAR_MAP: Readonly<Record<string, string>> = Object.fromEntries(
  Object.keys(BODY).map((joint) => [joint, joint]),
);
