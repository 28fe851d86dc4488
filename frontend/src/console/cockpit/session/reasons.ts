/** Reasons that come up again and again, one click away. */
import type { CommandType } from "@shared/api/types";
import type { Key } from "../../i18n";

export type Reasoned = Extract<
  CommandType,
  "redo" | "skip" | "abort" | "withdraw" | "override_stop"
>;

export const COMMON_REASONS: Readonly<Record<Reasoned | "pause", readonly Key[]>> = {
  pause: ["reason.break", "reason.tracking", "reason.question", "reason.unwell"],
  redo: ["reason.tracking", "reason.misunderstood", "reason.interrupted"],
  skip: ["reason.askedAloud", "reason.time", "reason.wish"],
  abort: ["reason.equipment", "reason.time", "reason.interrupted", "reason.stopRule"],
  override_stop: ["reason.recovered", "reason.mistyped"],
  withdraw: ["reason.wish", "reason.sick", "reason.unwell"],
};
