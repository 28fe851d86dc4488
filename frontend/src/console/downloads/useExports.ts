/** The account's exports: request, delete, and download those that are ready. */
import { type Export, type ExportWish, exports } from "@shared/api/housekeeping";
import { saveFile } from "@shared/saveFile";
import { type UseQueryResult, useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { useEffect, useSyncExternalStore } from "react";
import { exportsQuery } from "../queries";

export const isOpen = ({ state }: Export): boolean => state === "queued" || state === "making";

export function useExports(enabled: boolean): UseQueryResult<readonly Export[]> {
  return useQuery({ ...exportsQuery, enabled });
}

export function useOrder() {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: (wish: ExportWish) => exports.order(wish),
    onSuccess: (created) => {
      addRequest(created.id);
      queries.setQueryData(exportsQuery.queryKey, (previous) => [
        created,
        ...(previous ?? []).filter(({ id }) => id !== created.id),
      ]);
      void queries.invalidateQueries({ queryKey: exportsQuery.queryKey });
    },
  });
}

export function useRemoval() {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: (id: string) => {
      removeRequest(id);
      return exports.remove(id);
    },
    onSettled: () => queries.invalidateQueries({ queryKey: exportsQuery.queryKey }),
  });
}

/**
 * Start the browser's download of each export requested in this tab once it is ready; the browser
 * writes it to disk as it arrives.
 */
export function useAutomaticDownloads(list: readonly Export[] | undefined): void {
  const { requested } = useDownloads();
  const queries = useQueryClient();
  useEffect(() => {
    if (list === undefined) return;
    for (const id of requested) {
      const one = list.find((item) => item.id === id);
      if (one === undefined) removeRequest(id, true);
      else if (one.state === "failed") removeRequest(id);
      else if (one.state === "ready") {
        removeRequest(id);
        saveFile(exports.fileUrl(one.id), one.file_name);
        // It counts as fetched once the server has noticed the download.
        setTimeout(() => void queries.invalidateQueries({ queryKey: exportsQuery.queryKey }), 1000);
      }
    }
  }, [list, requested, queries]);
}

const KEY = "reembody.downloads.wanted";

/**
 * The list of downloads, and the exports that this tab has requested: each is downloaded as soon as
 * it is ready. They are remembered when the page is reloaded, and other tabs do not fetch them too.
 */
interface DownloadRequests {
  readonly opened: boolean;
  /** Exports that were requested here and are not downloaded yet. */
  readonly requested: readonly string[];
  /** One of them vanished before it was ready. */
  readonly hasVanished: boolean;
}

let desk: DownloadRequests = { opened: false, requested: storedRequests(), hasVanished: false };
const listeners = new Set<() => void>();

function storedRequests(): readonly string[] {
  return (sessionStorage.getItem(KEY) ?? "").split(" ").filter((id) => id !== "");
}

function change(next: Partial<DownloadRequests>): void {
  desk = { ...desk, ...next };
  sessionStorage.setItem(KEY, desk.requested.join(" "));
  for (const listener of listeners) listener();
}

export const openDownloads = (): void => change({ opened: true });
export const closeDownloads = (): void => change({ opened: false, hasVanished: false });
const addRequest = (id: string): void =>
  change({ requested: [...desk.requested.filter((one) => one !== id), id], hasVanished: false });
const removeRequest = (id: string, hasVanished = false): void =>
  change({
    requested: desk.requested.filter((one) => one !== id),
    hasVanished: desk.hasVanished || hasVanished,
  });

export function useDownloads(): DownloadRequests {
  return useSyncExternalStore(
    (listener) => {
      listeners.add(listener);
      return () => listeners.delete(listener);
    },
    () => desk,
  );
}
