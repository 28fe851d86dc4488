/** Which study is tried out where none is named. */
import { DEMO_KEY } from "@shared/api/housekeeping";
import type { StudySummary } from "@shared/api/types";

/** The study that is shipped with the product and needs no preparation. */
const SHIPPED = "reembodiment-latency";

/**
 * The study whose page is open, else the one that was open last, the shipped one, or the first.
 *
 * Never the demo lab's: its phases are too short to follow, and its figures are of its own people.
 */
export function studyToTry<Listed extends Pick<StudySummary, "key">>(
  address: string,
  listed: readonly Listed[],
  last: string | null,
): Listed | null {
  const here = /^\/studies\/([^/?]+)/.exec(address)?.[1];
  const others = listed.filter(({ key }) => key !== DEMO_KEY);
  const wanted = [here, last, SHIPPED].find((key) => others.some((study) => study.key === key));
  return others.find(({ key }) => key === wanted) ?? others[0] ?? null;
}
