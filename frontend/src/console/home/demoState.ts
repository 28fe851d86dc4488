/** Where the demo lab is shown, and what the first page says of it and of the studies. */
import { DEMO_KEY, type Demo, type LabState } from "@shared/api/housekeeping";
import type { SessionView, StudySummary } from "@shared/api/types";
import { sectionAt, studyIn } from "../frame/places";

/** Whether there is a demo lab of our own: somebody else's study may have its key. */
export const isThere = (found: Demo | null): found is Demo =>
  found !== null && found.state !== "absent";

/**
 * What of the demo lab an address shows: its study, the page where it is looked after, or a session
 * of a simulated person. A session of a person is none, also if somebody added it to that study.
 */
export function demoPlace(
  address: string,
  session: Pick<SessionView, "study_key" | "kind"> | null,
): "study" | "overview" | "session" | null {
  if (studyIn(address) === DEMO_KEY) {
    return sectionAt(address) === "overview" ? "overview" : "study";
  }
  if (!address.startsWith("/sessions/") || session?.study_key !== DEMO_KEY) return null;
  return session.kind === "simulated" ? "session" : null;
}

/** Who has taken part in the lab's studies so far: people, only others, or nobody. */
export function whoTookPart(
  studies: readonly Pick<StudySummary, "session_counts">[],
): "people" | "others" | "nobody" {
  const counts = studies.map(({ session_counts }) => session_counts);
  if (counts.some((of) => (of["people"] ?? 0) > 0)) return "people";
  return counts.some((of) => Object.values(of).some((count) => count > 0)) ? "others" : "nobody";
}

/** How far a study is: of its participants, or of the demo lab's simulated people. */
export function studyProgress(
  study: Pick<StudySummary, "key" | "session_counts">,
  progress: LabState["studies"][number],
  found: Demo | null,
): {
  readonly of: "home.progress" | "home.progress.preregistered" | "demo.finished";
  readonly completed: number;
  readonly planned: number;
} {
  if (study.key === DEMO_KEY && isThere(found) && (study.session_counts["people"] ?? 0) === 0) {
    return { of: "demo.finished", completed: found.completed, planned: found.people };
  }
  const { completed, planned, preregistered } = progress;
  return {
    of: preregistered ? "home.progress.preregistered" : "home.progress",
    completed,
    planned,
  };
}
