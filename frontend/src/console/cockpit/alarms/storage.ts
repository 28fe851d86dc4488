/** Trouble with the server's disk, as alarms: it concerns every session, and the record cannot tell. */
import type { StorageNews } from "@shared/api/types";
import type { ShownAlarm } from "./alarms";

export interface Storage {
  readonly news: StorageNews;
  /** When this page heard of it, as an ISO time. */
  readonly heardAt: string;
}

export function storageAlarms(storage: Storage | null): readonly ShownAlarm[] {
  if (storage === null) return [];
  const { news, heardAt } = storage;
  if (news.status === "failing") return [alarm("storage", "critical", news.since ?? heardAt)];
  return news.low_disk ? [alarm("low_disk", "warning", heardAt)] : [];
}

const alarm = (code: string, severity: ShownAlarm["severity"], since: string): ShownAlarm => ({
  key: `${code} ${since}`,
  code,
  severity,
  since,
  stream: null,
  joints: [],
  value: null,
  unit: null,
});
