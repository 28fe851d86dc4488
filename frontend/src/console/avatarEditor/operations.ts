/** The server's operations for what people do in the table. */
import type { Operation } from "./api";
import type { AvatarFile, Field } from "./axes";
import type { SingleField } from "./singleJoints";

/** Give axes one value of a limit or of a drive. */
export function setField(axes: readonly string[], field: Field, value: number): Operation[] {
  const operation = field === "low_deg" || field === "high_deg" ? "set_limits" : "set_gains";
  return [{ operation, targets: axes, [field]: value } as Operation];
}

const DRIVE = {
  kp: "kp_nm_per_rad",
  kd: "kd_nm_s_per_rad",
  torque: "max_torque_nm",
} as const;

/** Give the joints of parts one value in the single template. */
export function setJointField(
  parts: readonly string[],
  field: SingleField | string,
  value: number,
): Operation[] {
  const own = field.replace("shared_", "");
  const values = Object.hasOwn(DRIVE, own)
    ? {
        [field === own ? "drive" : "shared_drive"]: { [DRIVE[own as keyof typeof DRIVE]]: value },
      }
    : /^[XYZ]$/.test(field)
      ? { limits_deg: { [field]: value } }
      : { [field]: value };
  return [{ operation: "edit_joint", targets: parts, limits_deg: {}, ...values } as Operation];
}

const EVERYTHING = ["gains", "limits", "colliders", "casts", "delays", "compliance"] as const;

/** Replace the whole configuration by another one. */
export const loadFile = (configuration: AvatarFile): Operation[] => [
  { operation: "load", configuration, what: EVERYTHING },
];

/** Replace the whole configuration by a saved version. */
export const loadVersion = (key: string, version: number): Operation[] => [
  { operation: "load", key, version, what: EVERYTHING },
];

/** What groups can take from another avatar. */
export const ASPECTS = {
  gains: ["gains"],
  limits: ["limits"],
  group: EVERYTHING,
} as const;
export type Aspects = keyof typeof ASPECTS;

/** Take settings from a saved version, named `key number`: a group's, or for null all there are. */
export function takeFrom(
  version: string,
  groups: readonly string[] | null,
  aspects: Aspects,
): Operation[] {
  const [key = "", number = ""] = version.split(" ");
  if (groups === null) return loadVersion(key, Number(number));
  const what = ASPECTS[aspects];
  return [{ operation: "load", key, version: Number(number), targets: groups, what } as Operation];
}

/** Give one body group the settings that it has in the shipped avatar. */
export const resetGroup = (group: string): Operation[] => [
  { operation: "load", key: "standard", targets: [group], what: EVERYTHING },
];

/** Copy one side of the body to the other, or exchange both, with everything that a side has. */
export const mirror = (
  direction: "left_to_right" | "right_to_left" | "swap",
  targets: readonly string[] = ["all"],
): Operation[] => [{ operation: "mirror", direction, targets, what: EVERYTHING } as Operation];
