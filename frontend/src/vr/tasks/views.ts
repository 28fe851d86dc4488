/** What to display of a task's state: the goal, the colours and the numbers. */
import { redUnits, type TaskState } from "./state";

/** The four colours that a surface can have; a palette determines how each looks. */
export type Colour = "grey" | "green" | "white" | "red";

/**
 * The surface to touch next: a panel, the target, or the start square of a walk back.
 *
 * Before the start it is the first panel, and in a pause the goal that will be current when the phase
 * resumes; null once frozen.
 */
export function currentGoal(state: TaskState): string | null {
  const { layout } = state.rules;
  if (state.isFrozen) return null;
  if (state.walkBackSinceS !== null) return layout.startKey;
  const box = state.order[state.greenCount];
  return box === undefined ? layout.targetKey : layout.panelKey(box);
}

/**
 * The colour of every surface: panels grey or green, sides white or red, the target green, the start
 * square white. Sides are white while the clock is stopped: colours show what is being counted.
 */
export function surfaceColours(state: TaskState): ReadonlyMap<string, Colour> {
  const { layout } = state.rules;
  const red = redUnits(state);
  const green = new Set(state.order.slice(0, state.greenCount).map((box) => layout.panelKey(box)));
  const colours = new Map<string, Colour>();
  for (const { key, kind, unit } of layout.surfaces) {
    if (kind === "panel") colours.set(key, green.has(key) ? "green" : "grey");
    else if (kind === "side") colours.set(key, red.has(unit) ? "red" : "white");
    else colours.set(key, kind === "target" ? "green" : "white");
  }
  return colours;
}

/** The number shown at each box: its place in the current order, from 1. */
export function displayedNumbers(state: TaskState): ReadonlyMap<number, number> {
  return new Map(state.order.map((box, index) => [box, index + 1]));
}
