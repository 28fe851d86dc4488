const PAIRS_IN_A_GROUP = 4;

/** A fingerprint in groups of four pairs: as much as an eye compares at once. */
export function inGroups(fingerprint: string): readonly { at: number; text: string }[] {
  const pairs = fingerprint.split(":");
  const groups = Array.from({ length: Math.ceil(pairs.length / PAIRS_IN_A_GROUP) }, (_, at) => at);
  return groups.map((at) => ({
    at,
    text: pairs.slice(at * PAIRS_IN_A_GROUP, (at + 1) * PAIRS_IN_A_GROUP).join(":"),
  }));
}
