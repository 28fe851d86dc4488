/** What has been filled in so far: enough to resume on the same page after a reload. */
export interface FormDraft {
  /** What was chosen or typed, by item; items that are not answered are missing. */
  readonly data: Readonly<Record<string, unknown>>;
  readonly page: number;
  /** Seconds from when the form was first shown to the last change of each answer. */
  readonly timings: Readonly<Record<string, number>>;
  /** How long each answer took, and how often it was changed. */
  readonly traces: ItemTraces;
}

export const EMPTY_DRAFT: FormDraft = { data: {}, page: 0, timings: {}, traces: {} };

/**
 * How an item was answered: how long it took, and how often the answer was changed afterwards.
 *
 * Several items are on a page at once, so it is unknown when an item is read. The usual
 * approximation:
 * an item's *turn* starts when its page is shown or when another item of the page is answered, and
 * its
 * response time ends with its first answer. A typed answer is one answer until another item is
 * answered or the page is left: its time ends with the last keystroke of the first writing, and
 * each
 * later edit counts as one change.
 */
interface ItemTrace {
  readonly response_s: number;
  readonly changes: number;
}

export type ItemTraces = Readonly<Record<string, ItemTrace>>;

export interface Turn {
  /** The item being answered; null before the first answer on a page. */
  readonly item: string | null;
  /** When its turn started, and when it was last changed, on one monotonic clock. */
  readonly sinceMs: number;
  readonly lastMs: number;
  /** Whether it is being answered for the first time. */
  readonly first: boolean;
}

interface Answered {
  readonly item: string;
  /** Typed letter by letter, as opposed to chosen. */
  readonly typed: boolean;
}

export const pageShown = (nowMs: number): Turn => ({
  item: null,
  sinceMs: nowMs,
  lastMs: nowMs,
  first: false,
});

/** The traces and the turn after the answer to an item has changed. */
export function answered(
  traces: ItemTraces,
  turn: Turn,
  { item, typed }: Answered,
  nowMs: number,
): { readonly traces: ItemTraces; readonly turn: Turn } {
  const known = traces[item];
  const same = turn.item === item;
  const sinceMs = same ? turn.sinceMs : turn.lastMs;
  const writesOn = same && typed && known !== undefined;
  const first = writesOn ? turn.first : known === undefined;
  const response_s = first || known === undefined ? seconds(nowMs - sinceMs) : known.response_s;
  const before = known?.changes ?? 0;
  const changes = known === undefined || writesOn ? before : before + 1;
  return {
    traces: { ...traces, [item]: { response_s, changes } },
    turn: { item, sinceMs, lastMs: nowMs, first },
  };
}

const seconds = (ms: number): number => Math.max(0, Math.round(ms)) / 1000;
