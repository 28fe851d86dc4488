/**
 * A body's model with the arms of the person who wears it: the server's `Figure.with_arms`, for the
 * skin that is drawn.
 */
import type { BodyBinding } from "./pose";

/** Measured lengths from joint to joint, in metres; an arm keeps what is left out. */
export interface ArmsM {
  readonly upper_arm?: number | undefined;
  readonly forearm?: number | undefined;
}

const BONES = [
  ["UpperArm", "LowerArm", "upper_arm"],
  ["LowerArm", "Hand", "forearm"],
] as const;

/**
 * The binding of a model, in its own size, whose arms are of these lengths once the model is scaled
 * to the stature. Bones and their skin are stretched along themselves; hands keep their size.
 */
export function withArms(binding: BodyBinding, statureM: number, armsM: ArmsM): BodyBinding {
  const scale = statureM / binding.stature_m;
  const joints_m = binding.joints_m.map((place) => [...place]);
  const part_from_node = binding.part_from_node.map((rows) => [...rows]);
  for (const [start, end, segment] of BONES) {
    const lengthM = armsM[segment];
    if (lengthM === undefined) continue;
    for (const side of ["Left", "Right"]) {
      const [from, to] = [binding.parts.indexOf(side + start), binding.parts.indexOf(side + end)];
      const [begin, finish] = [binding.joints_m[from], binding.joints_m[to]];
      if (begin === undefined || finish === undefined) continue;
      const bone = finish.map((value, axis) => value - (begin[axis] ?? 0));
      const ratio = lengthM / scale / Math.hypot(...bone);
      for (let part = 0; part < joints_m.length; part++) {
        if (!isCarriedBy(binding, part, to)) continue;
        joints_m[part] = (joints_m[part] ?? []).map(
          (value, axis) => value + (ratio - 1) * (bone[axis] ?? 0),
        );
      }
      part_from_node[from] = stretched(part_from_node[from] ?? [], bone, ratio);
    }
  }
  return { ...binding, joints_m, part_from_node };
}

function isCarriedBy({ parents }: BodyBinding, part: number, joint: number): boolean {
  let above = part;
  while (above >= 0 && above !== joint) above = parents[above] ?? -1;
  return above >= 0;
}

/** A matrix, 16 numbers row by row, after which all is stretched along a bone. */
function stretched(rows: readonly number[], bone: readonly number[], ratio: number): number[] {
  const squared = bone.reduce((sum, value) => sum + value * value, 0);
  return rows.map((value, at) => {
    const [row, column] = [Math.floor(at / 4), at % 4];
    if (row === 3) return value;
    let along = 0;
    for (let axis = 0; axis < 3; axis++)
      along += (bone[axis] ?? 0) * (rows[4 * axis + column] ?? 0);
    return value + ((ratio - 1) * (bone[row] ?? 0) * along) / squared;
  });
}
