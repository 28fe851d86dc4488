/**
 * Which boxes are lit, according to the touches received: green stays until the task is completed.
 */
import type { PoseTouch } from "@shared/api/poses";
import type { BlockTone, BlockTones } from "@shared/stage/figure";

/** How long a touch that does not stay lit is shown. */
export const FLASH_MS = 900;

interface Lit {
  readonly tone: BlockTone;
  /** When the light goes out; infinite until the task is completed. */
  readonly until: number;
}

export interface Lights {
  readonly seen: readonly [epoch: number, seq: number];
  readonly phaseId: number;
  readonly lit: ReadonlyMap<string, Lit>;
  readonly last: PoseTouch | null;
}

export const DARK: Lights = { seen: [-1, -1], phaseId: 0, lit: new Map(), last: null };

const TONES: Readonly<Record<string, BlockTone>> = {
  green: "good",
  target: "good",
  side: "bad",
  out_of_order: "odd",
  wrong_part: "odd",
  early: "odd",
};

const isNewer = (one: PoseTouch["number"], other: PoseTouch["number"]): boolean =>
  one[0] !== other[0] ? one[0] > other[0] : one[1] > other[1];

/** Add the touches received; those seen before are sent repeatedly and change nothing. */
export function withTouches(before: Lights, touches: readonly PoseTouch[], now: number): Lights {
  const isFirst = before.seen[0] < 0;
  return touches
    .filter(({ number }) => isNewer(number, before.seen))
    .reduce((lights, touch) => withTouch(lights, touch, now, isFirst), before);
}

/** Add one touch. Touches from before this page was opened do not flash: only what stays is lit. */
function withTouch(before: Lights, touch: PoseTouch, now: number, isOld: boolean): Lights {
  const lit = new Map(touch.phase_id === before.phaseId ? before.lit : []);
  const after = { seen: touch.number, phaseId: touch.phase_id, last: touch };
  if (touch.kind === "completion") {
    for (const [key, one] of lit) lit.set(key, { ...one, until: now + FLASH_MS });
  } else if (touch.surface !== null) {
    const stays = touch.effect === "green";
    const flash = isOld ? now : now + FLASH_MS;
    const until = stays ? Number.POSITIVE_INFINITY : flash;
    const current = lit.get(touch.surface);
    // A completed panel stays lit, whatever else touches it.
    if (current === undefined || current.until < until) {
      lit.set(touch.surface, { tone: TONES[touch.effect] ?? "touched", until });
    }
  }
  return { ...after, lit };
}

/** The boxes that are lit now. */
export function tonesAt({ lit }: Lights, now: number): BlockTones {
  return new Map(
    [...lit].filter(([, one]) => one.until > now).map(([key, { tone }]) => [key, tone]),
  );
}

/** When the next light goes out; null if none will. */
export function nextChange({ lit }: Lights, now: number): number | null {
  const times = [...lit.values()].map(({ until }) => until).filter((until) => until > now);
  const next = Math.min(...times);
  return Number.isFinite(next) ? next : null;
}
