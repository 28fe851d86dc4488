/** The product's skeleton, 1 m tall, with the measured arms of a person. */
import { JOINTS, UNIT_SKELETON } from "@shared/avatar/anatomy.generated";

/** Lengths in metres by the names of an avatar's segments; usual ones for what is left out. */
export type SegmentsM = Readonly<Record<string, number>>;

/** Whose offset, and whose end, is how long a segment is. */
const ENDS: Readonly<Record<string, { readonly joint: string; readonly bone: string }>> = {
  upper_arm: { joint: "LowerArm", bone: "UpperArm" },
  forearm: { joint: "Hand", bone: "LowerArm" },
};
const SIDES = ["Left", "Right"] as const;
const ROW = new Map<string, number>(JOINTS.map((name, row) => [name, row]));

/** Joints' offsets and the ends of their capsules (3 values a joint), of somebody 1 m tall. */
export function unitSkeleton(
  statureM: number,
  segmentsM: SegmentsM = {},
): { readonly offsets: readonly number[]; readonly capsuleEnds: readonly number[] } {
  const offsets: number[] = [...UNIT_SKELETON.offsets];
  const capsuleEnds: number[] = [...UNIT_SKELETON.capsuleEnds];
  for (const [segment, { joint, bone }] of Object.entries(ENDS)) {
    const lengthM = segmentsM[segment];
    if (lengthM === undefined) continue;
    for (const side of SIDES) {
      const at = 3 * (ROW.get(side + joint) as number);
      const usual = Math.hypot(...offsets.slice(at, at + 3));
      const ratio = lengthM / statureM / usual;
      const end = 3 * (ROW.get(side + bone) as number);
      for (let i = 0; i < 3; i++) {
        offsets[at + i] = ratio * (offsets[at + i] as number);
        capsuleEnds[end + i] = ratio * (capsuleEnds[end + i] as number);
      }
    }
  }
  return { offsets, capsuleEnds };
}
