/**
 * Damping that fits a stiffness. A motor that turns an inertia I is critically damped with
 * kd = 2 sqrt(kp I): with a stiffness that is k times the saved one, the damping that is as critical
 * as the saved one is sqrt(k) times it. (The gains that come with Reembody are critically damped,
 * `app/science/avatar/mjcf/gains.py`, and those of a tuning by its rule `critical`.)
 */
import { type AvatarFile, isLocked } from "./axes";

export interface FittingDamping {
  readonly axis: string;
  /** N m s/rad. */
  readonly damping: number;
}

/** Digits of a damping that is proposed. */
const DIGITS = 4;
/** Dampings that differ by less than this share fit. */
const FITS = 0.005;

/** The axes whose stiffness was changed and whose damping was not, with the damping that fits. */
export function unfitting(base: AvatarFile, now: AvatarFile): readonly FittingDamping[] {
  return Object.entries(now.axes).flatMap(([axis, settings]) => {
    const saved = base.axes[axis];
    if (saved === undefined || isLocked(settings)) return [];
    const { kp_nm_per_rad: stiffness, kd_nm_s_per_rad: damping } = settings;
    if (damping !== saved.kd_nm_s_per_rad || saved.kp_nm_per_rad <= 0 || damping <= 0) return [];
    const fitting = damping * Math.sqrt(stiffness / saved.kp_nm_per_rad);
    if (Math.abs(fitting / damping - 1) < FITS) return [];
    return [{ axis, damping: Number(fitting.toPrecision(DIGITS)) }];
  });
}
