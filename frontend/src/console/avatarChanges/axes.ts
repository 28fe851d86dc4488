/**
 * What a joint's axis is called: the joint and the movement towards positive angles.
 *
 * Axes are named after the part they move and the letter of the axis in the T-pose, such as
 * `LeftLowerArmY`; people say "left elbow: bend".
 */
import type { Key, useTexts } from "../i18n";
import type { avatarChangesEn } from "./texts";

type Texts = ReturnType<typeof useTexts>;
type Movement = keyof typeof avatarChangesEn & `axis.move.${string}`;
type Letter = "X" | "Y" | "Z";

const AXIS = /^(Left|Right|)([A-Za-z]+)([XYZ])$/;
const FINGER = /^(Thumb|Index|Middle|Ring|Little)(Proximal|Intermediate|Distal)$/;

const TRUNK: Readonly<Record<Letter, Movement>> = {
  X: "axis.move.bendForward",
  Y: "axis.move.turn",
  Z: "axis.move.bendSideways",
};
const ONE_FINGER: Readonly<Record<Letter, Movement>> = {
  X: "axis.move.turn",
  Y: "axis.move.sideways",
  Z: "axis.move.bend",
};
const THUMB: Readonly<Record<Letter, Movement>> = {
  X: "axis.move.turn",
  Y: "axis.move.bend",
  Z: "axis.move.palm",
};
/** The limits and directions of these axes are those of `anatomy.generated.ts`. */
const MOVEMENTS: Readonly<Record<string, Readonly<Record<Letter, Movement>>>> = {
  Spine: TRUNK,
  Chest: TRUNK,
  UpperChest: TRUNK,
  Neck: TRUNK,
  Head: TRUNK,
  UpperArm: { X: "axis.move.turn", Y: "axis.move.forward", Z: "axis.move.raiseSideways" },
  LowerArm: { X: "axis.move.turn", Y: "axis.move.bend", Z: "axis.move.sideways" },
  Hand: { X: "axis.move.turn", Y: "axis.move.sideways", Z: "axis.move.bend" },
  UpperLeg: { X: "axis.move.raiseForward", Y: "axis.move.turn", Z: "axis.move.raiseSideways" },
  LowerLeg: { X: "axis.move.bend", Y: "axis.move.turn", Z: "axis.move.sideways" },
  Foot: { X: "axis.move.lift", Y: "axis.move.turn", Z: "axis.move.tilt" },
  Toes: { X: "axis.move.lift", Y: "axis.move.turn", Z: "axis.move.tilt" },
};

/** "left elbow" for `LeftLowerArm`; a part that moves about no named joint stays as it is. */
export function jointName({ t }: Pick<Texts, "t">, part: string): string {
  const [, side = "", name = ""] = AXIS.exec(`${part}X`) ?? [];
  const [, finger, phalanx] = FINGER.exec(name) ?? [];
  if (finger !== undefined) {
    return t(`axis.${phalanx}` as Key, { finger: t(`axis.joint.${side}${finger}` as Key) });
  }
  return name in MOVEMENTS ? t(`axis.joint.${side}${name}` as Key) : part;
}

/** "left elbow: bend" for `LeftLowerArmY`; a name that is no axis of the body stays as it is. */
export function axisName({ t }: Pick<Texts, "t">, axis: string): string {
  const [, side = "", part = "", letter = ""] = AXIS.exec(axis) ?? [];
  const [, finger] = FINGER.exec(part) ?? [];
  const movements =
    finger === undefined ? MOVEMENTS[part] : finger === "Thumb" ? THUMB : ONE_FINGER;
  const movement = movements?.[letter as Letter];
  if (movement === undefined) return axis;
  return t("axis.name", { joint: jointName({ t }, `${side}${part}`), movement: t(movement) });
}

/** Whether every word of a search is in the axis's words or in its own name. */
export function isFound(search: string, label: string, axis: string): boolean {
  const text = `${label} ${axis}`.toLowerCase();
  return search
    .toLowerCase()
    .split(/\s+/)
    .every((word) => text.includes(word));
}
