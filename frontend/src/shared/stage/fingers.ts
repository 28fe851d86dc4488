/** The finger parts of a body, which some recordings have besides its 22 joints. */

const SEGMENTS = ["Proximal", "Intermediate", "Distal"];

/** The 30 finger parts in the order of their values: left hand, then right, from the thumb on. */
export const FINGER_PARTS: readonly string[] = ["Left", "Right"].flatMap((side) =>
  ["Thumb", "Index", "Middle", "Ring", "Little"].flatMap((finger) =>
    SEGMENTS.map((segment) => `${side}${finger}${segment}`),
  ),
);

/** A figure's joints followed by the finger parts, each with its parent. */
export function withFingers(
  joints: readonly string[],
  parents: readonly number[],
): { readonly joints: readonly string[]; readonly parents: readonly number[] } {
  const ofFingers = FINGER_PARTS.map((part, index) => {
    const isFirst = index % SEGMENTS.length === 0;
    const hand = part.startsWith("Left") ? "LeftHand" : "RightHand";
    return isFirst ? joints.indexOf(hand) : joints.length + index - 1;
  });
  return { joints: [...joints, ...FINGER_PARTS], parents: [...parents, ...ofFingers] };
}

/**
 * Write rotations wxyz of the finger parts, from `first` on in `rotations`, to `values` from `at`
 * on. A part that is unknown is straight, as in the T-pose.
 */
export function writeFingers(
  rotations: ArrayLike<number>,
  first: number,
  values: Float32Array,
  at: number,
): void {
  for (let part = 0; part < FINGER_PARTS.length; part++) {
    let size = 0;
    for (let axis = 0; axis < 4; axis++) size += Math.abs(rotations[first + 4 * part + axis] ?? 0);
    for (let axis = 0; axis < 4; axis++) {
      // Neither NaN nor a rotation of zeros is known.
      const own = size > 0 ? (rotations[first + 4 * part + axis] ?? 0) : Number(axis === 0);
      values[at + 4 * part + axis] = own;
    }
  }
}
