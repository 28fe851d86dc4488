/** What a pilot of a version says of the walks back, which the protocol alone does not tell. */
import { useQuery } from "@tanstack/react-query";
import { usePermissions } from "../permissions";
import { type PilotListed, pilotsQuery } from "./pilots";

/** The walks back of a visit in minutes by the newest finished cohort of this content, or null. */
export function walksBackOf(
  known: readonly PilotListed[] | undefined,
  contentHash: string | null,
): number | null {
  const cohort = known?.find(
    ({ kind, state, content_hash }) =>
      kind === "cohort" && state === "ready" && content_hash === contentHash,
  );
  return cohort?.walk_back_min ?? null;
}

/** The same for a study; null also for those who may not see pilots. */
export function useWalksBack(studyKey: string | null, contentHash: string | null): number | null {
  const can = usePermissions();
  const { data } = useQuery({
    ...pilotsQuery(studyKey ?? ""),
    enabled: studyKey !== null && can("compare"),
  });
  return walksBackOf(data, contentHash);
}
