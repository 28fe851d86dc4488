/** The axes of a configuration as the table shows them: sections, filters, and what differs. */
import type { components } from "@shared/api/schema";
import { AXES, GROUPS as PARTS_OF } from "@shared/avatar/anatomy.generated";

export type AvatarFile = components["schemas"]["AvatarFile"];
export type AxisFile = components["schemas"]["AxisFile"];
export type Field = keyof AxisFile;

/** The columns of the table, in its order. */
export const FIELDS = [
  "low_deg",
  "high_deg",
  "kp_nm_per_rad",
  "kd_nm_s_per_rad",
  "max_torque_nm",
] as const satisfies readonly Field[];

export const UNITS: Readonly<Record<Field, string>> = {
  low_deg: "°",
  high_deg: "°",
  kp_nm_per_rad: "N m/rad",
  kd_nm_s_per_rad: "N m s/rad",
  max_torque_nm: "N m",
};

/** What the values of a column can be; the server refuses others, whoever sends them. */
export const RANGES: Readonly<Record<Field, readonly [least: number, greatest: number]>> = {
  low_deg: [-180, 180],
  high_deg: [-180, 180],
  kp_nm_per_rad: [0, 1e6],
  kd_nm_s_per_rad: [0, 1e6],
  max_torque_nm: [0, 1e6],
};

/** Groups of the body that do not overlap: the table has a section for each. */
export const SECTIONS = [
  "trunk",
  "head",
  "left_arm",
  "left_fingers",
  "left_leg",
  "right_arm",
  "right_fingers",
  "right_leg",
] as const;
export type Section = (typeof SECTIONS)[number];

const PART_OF: ReadonlyMap<string, string> = new Map(AXES.map(({ name, part }) => [name, part]));

export const partOf = (axis: string): string => PART_OF.get(axis) ?? axis.slice(0, -1);

/** The section of a body part. */
export const sectionOf = (part: string): Section =>
  SECTIONS.find((section) => PARTS_OF[section]?.includes(part)) ?? "trunk";

/** The body groups that casts, colliders and common edits can name, besides single parts. */
export const GROUPS: readonly string[] = Object.keys(PARTS_OF);

/** Whether a body part belongs to a group, or is the part that the group names. */
export const isIn = (group: string, part: string): boolean =>
  group === part || (PARTS_OF[group]?.includes(part) ?? false);

/** The axes of a group that a configuration has, in the body's order. */
export const axesOf = (configuration: AvatarFile, group: string): readonly string[] =>
  Object.keys(configuration.axes).filter((axis) => isIn(group, partOf(axis)));

/** Whether a cast holds the axis. */
export const isCast = (configuration: AvatarFile, axis: string): boolean =>
  configuration.locked_groups.some((group) => isIn(group, partOf(axis)));

/** Whether equal limits hold the axis. */
export const isLocked = ({ low_deg, high_deg }: AxisFile): boolean => low_deg === high_deg;

/** How a group gives way when it is pushed. */
export type Compliance = NonNullable<AvatarFile["compliance"]>[string];

export const STIFF = { stiffness_percent: 100, targets: "joint" } as const satisfies Compliance;
/** The groups whose parts can return to their own directions. */
export const LIMBS = ["left_arm", "right_arm", "left_leg", "right_leg"] as const;

/** How every group gives way; a file leaves out those that are stiff. */
export const complianceOf = (configuration: AvatarFile): Readonly<Record<Section, Compliance>> =>
  Object.fromEntries(
    SECTIONS.map((group) => [group, configuration.compliance?.[group] ?? STIFF]),
  ) as Record<Section, Compliance>;

/** A value that two configurations do not share; undefined where one lacks it. */
export interface Difference {
  /** The place in the file: `axes`, an axis and a field; or a key, perhaps with an entry. */
  readonly path: readonly string[];
  readonly before: unknown;
  readonly after: unknown;
}

/** Everything in which two configurations differ, the axes last and in the body's order. */
export function differences(before: AvatarFile, after: AvatarFile): readonly Difference[] {
  const found: Difference[] = [];
  const { axes: axesBefore, compliance: _, ...restBefore } = before;
  const { axes: axesAfter, compliance: __, ...restAfter } = after;
  compare(restBefore, restAfter, [], found);
  compare(complianceOf(before), complianceOf(after), ["compliance"], found);
  compare(axesBefore, axesAfter, ["axes"], found);
  return found;
}

type Tree = Readonly<Record<string, unknown>>;

const isTree = (value: unknown): value is Tree =>
  typeof value === "object" && value !== null && !Array.isArray(value);

function compare(before: Tree, after: Tree, path: readonly string[], into: Difference[]): void {
  for (const key of new Set([...Object.keys(before), ...Object.keys(after)])) {
    const [old, next] = [before[key], after[key]];
    if (JSON.stringify(old ?? null) === JSON.stringify(next ?? null)) continue;
    // A file leaves out maps without entries, such as the delays.
    if (isTree(old ?? next) && isTree(next ?? old)) {
      compare((old ?? {}) as Tree, (next ?? {}) as Tree, [...path, key], into);
    } else into.push({ path: [...path, key], before: old, after: next });
  }
}

export const FILTERS = ["all", "changed", "cast", "locked"] as const;
export type Filter = (typeof FILTERS)[number];

/** Whether a filter lets an axis of the configuration through; `base` is what it was made from. */
export function passes(
  filter: Filter,
  configuration: AvatarFile,
  base: AvatarFile,
  axis: string,
): boolean {
  const settings = configuration.axes[axis];
  if (settings === undefined) return false;
  if (filter === "cast") return isCast(configuration, axis);
  if (filter === "locked") return isLocked(settings);
  return filter === "all" || FIELDS.some((field) => settings[field] !== base.axes[axis]?.[field]);
}
