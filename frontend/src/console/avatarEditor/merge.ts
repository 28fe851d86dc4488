/** One's own changes, put onto what somebody else has saved meanwhile. */
import { type AvatarFile, complianceOf, type Difference, differences, STIFF } from "./axes";

type Tree = Record<string, unknown>;

/**
 * The configuration `theirs` with everything that `mine` changed since `start`, the version that
 * both began from. Where both changed a value, it is mine.
 */
export function withOwnChanges(
  start: AvatarFile,
  mine: AvatarFile,
  theirs: AvatarFile,
): AvatarFile {
  const merged = structuredClone({ ...theirs, compliance: complianceOf(theirs) }) as Tree;
  for (const { path, after } of differences(start, mine)) put(merged, path, after);
  const soft = Object.entries(merged.compliance as Tree).filter(([, one]) => !isStiff(one));
  merged.compliance = Object.fromEntries(soft);
  if (soft.length === 0 && theirs.compliance === undefined) delete merged.compliance;
  return merged as unknown as AvatarFile;
}

/** The values that both changed since `start`, each in a way of its own. */
export function changedByBoth(
  start: AvatarFile,
  mine: AvatarFile,
  theirs: AvatarFile,
): readonly Difference[] {
  const nameOf = ({ path }: Difference) => path.join(" ");
  const differing = new Set(differences(mine, theirs).map(nameOf));
  const own = new Set(differences(start, mine).map(nameOf));
  return differences(start, theirs).filter(
    (one) => own.has(nameOf(one)) && differing.has(nameOf(one)),
  );
}

/** The value at a place that `differences` names. */
export function valueAt(file: AvatarFile, path: readonly string[]): unknown {
  let value: unknown = { ...file, compliance: complianceOf(file) };
  for (const key of path) value = (value as Tree | null | undefined)?.[key];
  return value;
}

function put(tree: Tree, [key = "", ...rest]: readonly string[], value: unknown): void {
  if (rest.length > 0) {
    tree[key] ??= {};
    put(tree[key] as Tree, rest, value);
  } else if (value === undefined) delete tree[key];
  else tree[key] = value;
}

const isStiff = (one: unknown): boolean => JSON.stringify(one) === JSON.stringify(STIFF);
