/** The person's exports, ordering and removing them, and handing over those that are ready. */
import { type Export, type ExportWish, exports } from "@shared/api/housekeeping";
import { type UseQueryResult, useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect } from "react";
import { exportsQuery } from "../queries";
import { useDesk, want, wantNoMore } from "./desk";

export const isOpen = ({ state }: Export): boolean => state === "queued" || state === "making";

export function useExports(enabled: boolean): UseQueryResult<readonly Export[]> {
  return useQuery({ ...exportsQuery, enabled });
}

export function useOrder() {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: (wish: ExportWish) => exports.order(wish),
    onSuccess: (made) => {
      want(made.id);
      queries.setQueryData(exportsQuery.queryKey, (known) => [
        made,
        ...(known ?? []).filter(({ id }) => id !== made.id),
      ]);
      void queries.invalidateQueries({ queryKey: exportsQuery.queryKey });
    },
  });
}

export function useRemoval() {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: (id: string) => {
      wantNoMore(id);
      return exports.remove(id);
    },
    onSettled: () => queries.invalidateQueries({ queryKey: exportsQuery.queryKey }),
  });
}

/** Hands what this tab ordered to the browser, which writes it to the disk as it arrives. */
export function useHandingOver(list: readonly Export[] | undefined): void {
  const { wanted } = useDesk();
  const queries = useQueryClient();
  useEffect(() => {
    if (list === undefined) return;
    for (const id of wanted) {
      const one = list.find((known) => known.id === id);
      if (one === undefined) wantNoMore(id, true);
      else if (one.state === "failed") wantNoMore(id);
      else if (one.state === "ready") {
        wantNoMore(id);
        save(one);
        // It counts as fetched once the server has heard of it.
        setTimeout(() => void queries.invalidateQueries({ queryKey: exportsQuery.queryKey }), 1000);
      }
    }
  }, [list, wanted, queries]);
}

function save(one: Export): void {
  const link = document.createElement("a");
  link.href = exports.fileUrl(one.id);
  link.download = one.file_name;
  link.click();
}
