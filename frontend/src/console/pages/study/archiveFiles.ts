/** What the archive of a study can contain, in the order in which it is listed. */
import type { StudyDetail } from "@shared/api/types";

const FILES = [
  "sessions",
  "phases",
  "answers",
  "scores",
  "wide",
  "corrections",
  "completions",
  "contacts",
  "jointErrors",
  "jointErrorCourse",
  "events",
  "quality",
  "alarms",
  "doubts",
  "clocks",
  "headset",
  "road",
  "samples",
  "trackers",
  "companions",
  "receipts",
  "protocol",
  "imported",
  "calibrations",
  "codebook",
] as const;

/** The files that a study's archive can have; operators of a blinded study are told all. */
export function filesOf({ protocol }: Pick<StudyDetail, "protocol">): readonly File[] {
  const hasRoad = protocol === null || protocol.procedure.block.crossing !== undefined;
  return FILES.filter((file) => file !== "road" || hasRoad);
}

type File = (typeof FILES)[number];
