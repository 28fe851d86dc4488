/** Undo and redo: every state that was reached is kept as it was, so going back restores it exactly. */

export interface History<State> {
  readonly past: readonly State[];
  readonly now: State;
  readonly future: readonly State[];
}

/** More steps than anybody takes back; older ones are forgotten. */
const LONGEST = 200;

/** The states since the last one that fits, itself left out: what was done since it was saved. */
export function since<State>(
  { past, now }: History<State>,
  isSaved: (state: State) => boolean,
): readonly State[] {
  const states = [...past, now];
  return states.slice(states.findLastIndex(isSaved) + 1);
}

export const begun = <State>(now: State): History<State> => ({ past: [], now, future: [] });

/** Reach a new state; what had been undone can no longer be redone. */
export const reached = <State>({ past, now }: History<State>, next: State): History<State> => ({
  past: [...past, now].slice(-LONGEST),
  now: next,
  future: [],
});

export function undone<State>(history: History<State>): History<State> {
  const before = history.past.at(-1);
  if (before === undefined) return history;
  return {
    past: history.past.slice(0, -1),
    now: before,
    future: [history.now, ...history.future],
  };
}

export function redone<State>(history: History<State>): History<State> {
  const [next, ...rest] = history.future;
  if (next === undefined) return history;
  return { past: [...history.past, history.now], now: next, future: rest };
}
