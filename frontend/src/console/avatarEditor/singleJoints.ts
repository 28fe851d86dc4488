/** The columns of the single template: one joint per body part, as game engines have it. */
import type { Key } from "../i18n";
import type { JointView } from "./api";

export type SingleField =
  | "low_deg"
  | "high_deg"
  | "kp"
  | "kd"
  | "torque"
  | "X"
  | "Y"
  | "Z"
  | "shared_kp"
  | "shared_kd"
  | "shared_torque";

interface SingleColumn {
  readonly key: SingleField;
  readonly unit: string;
  readonly title: Key;
  readonly range: readonly [least: number, greatest: number];
}

const ANGLE = [-180, 180] as const;
const AMOUNT = [0, 1e6] as const;

/** The primary axis first; the others have symmetric limits and one drive together. */
export const SINGLE_COLUMNS: readonly SingleColumn[] = [
  { key: "low_deg", unit: "°", title: "avatars.single.low", range: ANGLE },
  { key: "high_deg", unit: "°", title: "avatars.single.high", range: ANGLE },
  { key: "kp", unit: "N m/rad", title: "avatars.single.kp", range: AMOUNT },
  { key: "kd", unit: "N m s/rad", title: "avatars.single.kd", range: AMOUNT },
  { key: "torque", unit: "N m", title: "avatars.single.torque", range: AMOUNT },
  { key: "X", unit: "± °", title: "avatars.single.X", range: [0, 180] },
  { key: "Y", unit: "± °", title: "avatars.single.Y", range: [0, 180] },
  { key: "Z", unit: "± °", title: "avatars.single.Z", range: [0, 180] },
  { key: "shared_kp", unit: "N m/rad", title: "avatars.single.sharedKp", range: AMOUNT },
  { key: "shared_kd", unit: "N m s/rad", title: "avatars.single.sharedKd", range: AMOUNT },
  { key: "shared_torque", unit: "N m", title: "avatars.single.sharedTorque", range: AMOUNT },
];

/** The numbers of a joint in the order of the columns; null for what it does not have. */
export function singleCells(joint: JointView): readonly (number | null)[] {
  const { low_deg, high_deg, drive, shared_drive: shared = null } = joint;
  const limits = new Map(
    Object.entries(joint.limits_deg).map(([axis, limit]) => [axis.slice(-1), limit]),
  );
  const of: Readonly<Record<SingleField, number | null>> = {
    low_deg,
    high_deg,
    kp: drive.kp_nm_per_rad,
    kd: drive.kd_nm_s_per_rad,
    torque: drive.max_torque_nm,
    X: limits.get("X") ?? null,
    Y: limits.get("Y") ?? null,
    Z: limits.get("Z") ?? null,
    shared_kp: shared?.kp_nm_per_rad ?? null,
    shared_kd: shared?.kd_nm_s_per_rad ?? null,
    shared_torque: shared?.max_torque_nm ?? null,
  };
  return SINGLE_COLUMNS.map(({ key }) => of[key]);
}
