/** The three times of a moment: the phase's, the active time, and the hour. */
import type { Replay } from "@shared/api/replays";

/** What the active time shows at a time of the phase; it stands between its stretches. */
export function activeAt({ active }: Pick<Replay, "active">, time: number): number {
  let shown = 0;
  for (const one of active) {
    if (time < one.begin_s) break;
    shown = one.begin_active_s + Math.min(time, one.end_s) - one.begin_s;
  }
  return shown;
}

export const isActive = ({ active }: Pick<Replay, "active">, time: number): boolean =>
  active.some(({ begin_s, end_s }) => begin_s <= time && time < end_s);

/** The moment by the server's clock; null where no run of the headset can be brought onto it. */
export function wallAt(
  { runs, time_scale }: Pick<Replay, "runs" | "time_scale">,
  time: number,
): Date | null {
  let found: Date | null = null;
  for (const run of runs) {
    if (run.begin_utc === null || (found !== null && time < run.begin_s)) continue;
    const since = ((time - run.begin_s) / time_scale) * 1000;
    found = new Date(new Date(run.begin_utc).getTime() + since);
  }
  return found;
}
