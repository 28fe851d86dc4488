/** Parts of a body that are marked because their settings were changed while it runs. */

/** Joints (HumanBodyBones names) that are in a cast, and those that pass through everything. */
export interface BodyMarks {
  readonly cast: readonly string[];
  readonly passing: readonly string[];
}

export const NO_MARKS: BodyMarks = { cast: [], passing: [] };
/** Two of the colours of Okabe and Ito, far apart for everybody; the forms differ, too. */
export const MARK_COLOURS = { cast: "#f0e442", passing: "#cc79a7" } as const;
