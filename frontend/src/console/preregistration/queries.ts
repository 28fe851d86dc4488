/** The read of a study's preregistration, with the key under which it is kept. */
import { preregistrations } from "@shared/api/preregistration";
import type { DataKind } from "@shared/api/types";
import { queryOptions } from "@tanstack/react-query";

export const preregistrationQuery = (key: string, kind: DataKind) =>
  queryOptions({
    queryKey: ["studies", key, "preregistration", kind],
    queryFn: () => preregistrations.get(key, kind),
  });
