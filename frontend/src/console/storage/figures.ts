/** The disk in three parts that fill it: used by this server, used by others, free. */
import type { StorageRoom } from "@shared/api/housekeeping";

interface DiskShares {
  readonly own: number;
  readonly other: number;
  readonly free: number;
  readonly total: number;
}

export function diskShares({ disk, parts }: StorageRoom): DiskShares {
  // If the database is elsewhere, only folders are on this disk.
  const onThisDisk = parts.filter(
    ({ place }) => disk.holds_database || place === "backups" || place === "scratch",
  );
  const used = Math.max(0, disk.total_bytes - disk.free_bytes);
  const own = Math.min(
    used,
    onThisDisk.reduce((sum, part) => sum + part.bytes, 0),
  );
  return { own, other: used - own, free: disk.free_bytes, total: disk.total_bytes };
}

/** Round to two significant digits: a forecast is no more exact than the mean it comes from. */
export function roundToTwoDigits(count: number): number {
  if (count < 100) return count;
  const step = 10 ** (Math.floor(Math.log10(count)) - 1);
  return Math.floor(count / step) * step;
}
