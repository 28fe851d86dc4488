/** Which axes of a tuning are accepted, and what has to happen to the work for that. */
import type { Operation } from "../api";
import { type AvatarFile, isCast, isIn, isLocked, partOf, SECTIONS } from "../axes";
import type { TunedAxis } from "./tunings";

/** What somebody chose, by axis; the others are as the tuning suggests. */
export type Choices = Readonly<Record<string, boolean>>;

/** An axis that has new gains. */
export interface NewGains extends TunedAxis {
  readonly kp: number;
  readonly kd: number;
}

export const hasGains = (axis: TunedAxis): axis is NewGains => axis.kp != null && axis.kd != null;

/** Whether an axis takes part; the others are locked or were not chosen. */
export const isTuned = ({ status }: TunedAxis): boolean => status !== "kept" && status !== "locked";

/** Whether the new gains of an axis are accepted: as chosen, otherwise unless it is doubtful. */
export const isAccepted = (axis: TunedAxis, choices: Choices): boolean =>
  hasGains(axis) && (choices[axis.name] ?? (axis.status === "tuned" || axis.status === "retried"));

/** Whether the work has the new gains of an axis already. */
export function isInWork(work: AvatarFile, { name, kp, kd }: TunedAxis): boolean {
  const own = work.axes[name];
  return own !== undefined && own.kp_nm_per_rad === kp && own.kd_nm_s_per_rad === kd;
}

const isNew = (axis: NewGains): boolean => axis.kp !== axis.kp_before || axis.kd !== axis.kd_before;

/** The accepted axes whose gains the work does not have yet. */
export const toTake = (
  work: AvatarFile,
  rows: readonly TunedAxis[],
  choices: Choices,
): readonly NewGains[] =>
  rows.filter(
    (axis): axis is NewGains =>
      axis.name in work.axes && isAccepted(axis, choices) && !isInWork(work, axis),
  );

/** The rejected axes whose new gains are in the work all the same. */
export const toPutBack = (
  work: AvatarFile,
  rows: readonly TunedAxis[],
  choices: Choices,
): readonly NewGains[] =>
  rows
    .filter(hasGains)
    .filter((axis) => isNew(axis) && !isAccepted(axis, choices) && isInWork(work, axis));

/** The edits that give axes their new gains, or those from before. */
export const gainsOf = (axes: readonly NewGains[], when: "before" | "after"): Operation[] =>
  axes.map(({ name, kp, kd, kp_before, kd_before }) => ({
    operation: "set_gains",
    targets: [name],
    kp_nm_per_rad: when === "after" ? kp : kp_before,
    kd_nm_s_per_rad: when === "after" ? kd : kd_before,
  }));

/** The tuned configuration with the gains of the work, so that only other values differ. */
export function withGainsOf(work: AvatarFile, tuned: AvatarFile): AvatarFile {
  const axes = Object.entries(tuned.axes).flatMap(([name, settings]) => {
    const own = work.axes[name];
    if (own === undefined) return [];
    const { kp_nm_per_rad, kd_nm_s_per_rad } = own;
    return [[name, { ...settings, kp_nm_per_rad, kd_nm_s_per_rad }]];
  });
  return { ...tuned, axes: Object.fromEntries(axes) };
}

const counterpart = (axis: string): string => axis.replace(/^Left/, "Right");

/** The axes that are tuned for a choice; mirroring adds the right-hand side of left ones. */
export function tunedFor(
  configuration: AvatarFile,
  chosen: readonly string[],
  isMirrored: boolean,
): readonly string[] {
  const wished = new Set(isMirrored ? chosen.flatMap((one) => [one, counterpart(one)]) : chosen);
  return Object.entries(configuration.axes)
    .filter(([name, own]) => wished.has(name) && !isLocked(own) && !isCast(configuration, name))
    .map(([name]) => name);
}

/** The root mean square of the figures of each body group that has any: axes count alike. */
export function byGroup(figures: Readonly<Record<string, number>>): readonly [string, number][] {
  return SECTIONS.flatMap((section): [string, number][] => {
    const own = Object.entries(figures).filter(([axis]) => isIn(section, partOf(axis)));
    if (own.length === 0) return [];
    const squares = own.reduce((sum, [, value]) => sum + value * value, 0);
    return [[section, Math.sqrt(squares / own.length)]];
  });
}
