/** The events of a phase in order, and the state of the boxes at a moment. */
import type { Replay, ReplayContact, ReplayMoment } from "@shared/api/replays";
import type { BlockTone, BlockTones } from "@shared/stage/figure";

interface Timed {
  readonly key: string;
  readonly time: number;
}

export interface Touch extends Timed {
  readonly kind: "touch";
  readonly surfaceKind: string;
  readonly box: number | null;
  readonly side: string | null;
  readonly parts: readonly string[];
  readonly effect: string;
  readonly end: number;
}

interface TaskCompletion extends Timed {
  readonly kind: "done";
  readonly number: number;
  readonly duration: number;
}

interface Clock extends Timed {
  readonly kind: "clock";
  readonly what: ReplayMoment["what"];
  readonly cause: string | null;
}

interface Note extends Timed {
  readonly kind: "note";
  readonly text: string;
  readonly by: string;
}

export type ReplayEvent = Touch | TaskCompletion | Clock | Note;

/**
 * All events in order of time; body parts that touch the same surface simultaneously are one touch.
 */
export function eventsOf(replay: Replay): readonly ReplayEvent[] {
  const clock = replay.moments.map(
    ({ what, t_s, cause }, at): Clock => ({
      kind: "clock",
      key: `clock ${at}`,
      time: t_s,
      what,
      cause,
    }),
  );
  const done = replay.completions.map(
    ({ number, t_s, duration_s }): TaskCompletion => ({
      kind: "done",
      key: `done ${number}`,
      time: t_s,
      number,
      duration: duration_s,
    }),
  );
  const notes = replay.notes.map(
    ({ id, t_s, text, by }): Note => ({ kind: "note", key: id, time: t_s, text, by }),
  );
  const all = [...clock, ...touches(replay.contacts), ...done, ...notes];
  return all.sort((one, other) => one.time - other.time);
}

/** The precedence of judgements when simultaneous touches are merged. */
const RANK = ["out_of_order", "wrong_part", "early", "green", "side", "target", "start"];
const rank = (effect: string): number =>
  (RANK.indexOf(effect) + RANK.length + 1) % (RANK.length + 1);

export function touches(contacts: readonly ReplayContact[]): readonly Touch[] {
  const bySurface = new Map<string, ReplayContact[]>();
  for (const contact of contacts) {
    bySurface.set(contact.surface, [...(bySurface.get(contact.surface) ?? []), contact]);
  }
  return [...bySurface.values()].flatMap(mergedTouches);
}

function mergedTouches(contacts: readonly ReplayContact[]): readonly Touch[] {
  const found: Touch[] = [];
  for (const one of [...contacts].sort((a, b) => a.begin_s - b.begin_s)) {
    const before = found.at(-1);
    if (before !== undefined && one.begin_s <= before.end) {
      found[found.length - 1] = {
        ...before,
        end: Math.max(before.end, one.end_s),
        parts: [...new Set([...before.parts, one.body_part])],
        effect: rank(one.effect) < rank(before.effect) ? one.effect : before.effect,
      };
    } else found.push(touchOf(one));
  }
  return found;
}

const touchOf = (one: ReplayContact): Touch => ({
  kind: "touch",
  key: `${one.surface} ${one.begin_s}`,
  time: one.begin_s,
  end: one.end_s,
  surfaceKind: one.surface_kind,
  box: one.box,
  // hand/2/left, hand/2/front_rim/top
  side: one.surface_kind === "side" ? (one.surface.split("/")[2] ?? null) : null,
  parts: [one.body_part],
  effect: one.effect,
});

const ODD = new Set(["out_of_order", "wrong_part", "early"]);

export const toneOf = ({
  surfaceKind,
  effect,
}: Pick<Touch, "surfaceKind" | "effect">): BlockTone =>
  surfaceKind === "side"
    ? "bad"
    : ODD.has(effect)
      ? "odd"
      : effect === "green"
        ? "good"
        : "touched";

/** A shorter touch is shown with this duration, seconds. */
const MIN_DURATION_S = 0.15;

/**
 * The tones of the blocks at a moment: panels stay good until the task is completed, everything
 * else glows while it is touched.
 */
export function tonesAt(
  { contacts, completions }: Pick<Replay, "contacts" | "completions">,
  time: number,
): BlockTones {
  const tones = new Map<string, BlockTone>();
  const since = completions.reduce(
    (last, { t_s }) => (t_s <= time ? Math.max(last, t_s) : last),
    -1,
  );
  for (const { surface, surface_kind, effect, begin_s, end_s } of contacts) {
    if (begin_s > time) continue;
    const tone = toneOf({ surfaceKind: surface_kind, effect });
    const on = time <= Math.max(end_s, begin_s + MIN_DURATION_S);
    if (tone === "good" ? begin_s > since : on && tones.get(surface) !== "good") {
      tones.set(surface, tone);
    }
  }
  return tones;
}

/** The last event up to a time; -1 before the first. */
export function latestEventAt(all: readonly Timed[], time: number): number {
  let low = 0;
  let high = all.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((all[middle]?.time ?? 0) <= time + 1e-6) low = middle + 1;
    else high = middle;
  }
  return low - 1;
}

/** The time to jump to: the nearest event before or after; null if there is none. */
export function jumpFrom(all: readonly Timed[], time: number, way: -1 | 1): number | null {
  const EPSILON_S = 0.02;
  const found =
    way > 0
      ? all.find((one) => one.time > time + EPSILON_S)
      : all.findLast((one) => one.time < time - EPSILON_S);
  return found?.time ?? null;
}

// The three times of a moment: the phase's, the active time, and the time of day.

/** The active time at a time of the phase; it stands still between its intervals. */
export function activeAt({ active }: Pick<Replay, "active">, time: number): number {
  let shown = 0;
  for (const one of active) {
    if (time < one.begin_s) break;
    shown = one.begin_active_s + Math.min(time, one.end_s) - one.begin_s;
  }
  return shown;
}

const ENDS = new Set<ReplayMoment["what"]>(["time_up", "ended"]);
const STOPS = new Set<ReplayMoment["what"]>(["paused", "walk_back_started"]);
/** Active time and the moments of its changes come from different counts, seconds. */
const SAME_S = 0.05;

/** When the phase's clock stopped for good; what was recorded later counts for nothing. */
export function endOf({
  active,
  moments,
  duration_s,
}: Pick<Replay, "active" | "moments" | "duration_s">): number {
  const last = active.at(-1)?.end_s ?? 0;
  const end = moments.find(({ what, t_s }) => ENDS.has(what) && t_s > last - SAME_S);
  if (end !== undefined) return Math.min(Math.max(end.t_s, last), duration_s);
  // The headset has not reported the end: it was where the clock last ran, unless it was paused.
  const before = moments.findLast(({ what }) => what !== "voided");
  return before === undefined || STOPS.has(before.what) ? duration_s : Math.min(last, duration_s);
}

/** Whether the clock ran at a time, was paused, or had stopped for good. */
export function clockAt(
  replay: Pick<Replay, "active" | "moments" | "duration_s">,
  time: number,
): "active" | "standing" | "over" {
  if (isActive(replay, time)) return "active";
  const end = endOf(replay);
  return end < replay.duration_s && time >= end ? "over" : "standing";
}

/** Whether the clock was paused for a time that can be seen. */
export function isEverPaused(replay: Pick<Replay, "active" | "moments" | "duration_s">): boolean {
  let ran = 0;
  for (const { begin_s, end_s } of replay.active) {
    if (begin_s - ran > SAME_S) return true;
    ran = end_s;
  }
  return endOf(replay) - ran > SAME_S;
}

export const isActive = ({ active }: Pick<Replay, "active">, time: number): boolean =>
  active.some(({ begin_s, end_s }) => begin_s <= time && time < end_s);

/** The moment by the server's clock; null if the headset's clock cannot be converted to it. */
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
