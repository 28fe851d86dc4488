/** A joint map that is being edited: its history, its current state, and its problems. */

/** The joint of the skeleton for each body joint. */
export type BodyMap = Readonly<Record<string, string>>;

export interface MapEdit {
  readonly past: readonly BodyMap[];
  readonly present: BodyMap;
  readonly future: readonly BodyMap[];
}

export const begin = (map: BodyMap): MapEdit => ({ past: [], present: map, future: [] });

const step = (edit: MapEdit, next: BodyMap): MapEdit =>
  sameMap(edit.present, next)
    ? edit
    : { past: [...edit.past, edit.present], present: next, future: [] };

/** Assign a joint of the skeleton to a body joint; null removes the assignment. */
export function assign(edit: MapEdit, bodyJoint: string, rigJoint: string | null): MapEdit {
  const { [bodyJoint]: _before, ...rest } = edit.present;
  return step(edit, rigJoint === null ? rest : { ...rest, [bodyJoint]: rigJoint });
}

/** Replace the whole map, as a step that can be undone. */
export const replace = (edit: MapEdit, map: BodyMap): MapEdit => step(edit, map);

export function undo(edit: MapEdit): MapEdit {
  const before = edit.past.at(-1);
  if (before === undefined) return edit;
  return {
    past: edit.past.slice(0, -1),
    present: before,
    future: [edit.present, ...edit.future],
  };
}

export function redo(edit: MapEdit): MapEdit {
  const [next, ...later] = edit.future;
  if (next === undefined) return edit;
  return { past: [...edit.past, edit.present], present: next, future: later };
}

export function sameMap(one: BodyMap, other: BodyMap): boolean {
  const keys = Object.keys(one);
  return keys.length === Object.keys(other).length && keys.every((key) => one[key] === other[key]);
}

export interface Hierarchy {
  readonly names: readonly string[];
  readonly parents: readonly number[];
}

export type MapProblem =
  | { readonly kind: "twice"; readonly other: string }
  | { readonly kind: "order"; readonly above: string; readonly aboveJoint: string }
  | { readonly kind: "hips" };

/**
 * What the server would reject, by body joint, so that it is shown during editing.
 *
 * A joint of the skeleton is assigned only once; a body joint further from the root is further down
 * the skeleton; without hips no body can be placed.
 */
export function problemsOf(
  map: BodyMap,
  body: Readonly<Record<string, string | null>>,
  rig: Hierarchy,
): ReadonlyMap<string, MapProblem> {
  const problems = new Map<string, MapProblem>();
  for (const [joint, name] of Object.entries(map)) {
    const twin = Object.keys(map).find((other) => other !== joint && map[other] === name);
    const above = mappedAbove(joint, map, body);
    const aboveJoint = above === null ? undefined : map[above];
    if (twin !== undefined) problems.set(joint, { kind: "twice", other: twin });
    else if (above !== null && aboveJoint !== undefined && !isBelow(rig, name, aboveJoint)) {
      problems.set(joint, { kind: "order", above, aboveJoint });
    }
  }
  if (map.Hips === undefined) problems.set("Hips", { kind: "hips" });
  return problems;
}

function mappedAbove(
  joint: string,
  map: BodyMap,
  body: Readonly<Record<string, string | null>>,
): string | null {
  let above = body[joint] ?? null;
  while (above !== null && map[above] === undefined) above = body[above] ?? null;
  return above;
}

function isBelow({ names, parents }: Hierarchy, name: string, above: string): boolean {
  const expected = names.indexOf(above);
  let at = parents[names.indexOf(name)] ?? -1;
  while (at >= 0 && at !== expected) at = parents[at] ?? -1;
  return at >= 0 && at === expected;
}
