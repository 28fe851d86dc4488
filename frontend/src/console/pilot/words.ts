/** The words for a pilot and for how far it is. */
import { duration } from "@shared/format";
import { seconds } from "@shared/units";
import type { useTexts } from "../i18n";
import type { Pilot, PilotListed } from "./pilots";

type Translate = ReturnType<typeof useTexts>["t"];

export const whatOf = (t: Translate, { kind, participants, seed }: PilotListed): string =>
  kind === "cohort"
    ? t("pilot.what.cohort", { count: participants[0] ?? 0, seed })
    : t("pilot.what.power", { numbers: participants.join(", "), seed });

/** How far it is: its stage, and the time left of that if it is known. */
export function courseOf(t: Translate, { progress }: Pilot): string {
  if (progress === null) return "";
  if (progress.waiting) return t("pilot.waiting");
  if (progress.held) return t("pilot.held");
  const { stage, done, total, remaining_s } = progress;
  const words = t(`pilot.stage.${stage}`, { done, total });
  return remaining_s === null || done === total
    ? words
    : `${words}, ${t("pilot.stage.left", { time: duration(seconds(Math.ceil(remaining_s))) })}`;
}
