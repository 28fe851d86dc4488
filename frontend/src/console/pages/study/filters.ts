/** How many fields of the dashboard's filter limit what is shown. */
import { type Filter, filterFrom } from "@shared/api/analysis";
import type { DataKind } from "@shared/api/types";

/** Everything of a kind. */
export const unfiltered = (kind: DataKind): Filter => ({
  ...filterFrom(new URLSearchParams()),
  kind,
});

/** The number of fields that differ from showing everything of the same kind. */
export function chosenFields(filter: Filter): number {
  const none = unfiltered(filter.kind);
  return Object.entries(none).filter(
    ([name, value]) => JSON.stringify(filter[name as keyof Filter]) !== JSON.stringify(value),
  ).length;
}
