/** The words for a pilot and for how far it is. */
import { duration } from "@shared/format";
import { seconds } from "@shared/units";
import type { useTexts } from "../i18n";
import type { Pilot, PilotListed } from "./pilots";

type Translate = ReturnType<typeof useTexts>["t"];

export const whatOf = (t: Translate, pilot: PilotListed): string => {
  const { kind, participants, seed, avatar, sets } = pilot;
  return kind === "cohort"
    ? t("pilot.what.cohort", {
        count: participants[0] ?? 0,
        avatar: t(`pilot.what.${avatar ?? "physics"}`),
        seed,
      })
    : t("pilot.what.power", { numbers: participants.join(", "), sets: sets ?? 0, seed });
};

/** Its state in a word; one that has been started may still wait for its turn, or be held. */
export function stateOf(t: Translate, { state, progress }: PilotListed): string {
  if (state !== "simulating" || progress === null) return t(`pilot.state.${state}`);
  if (progress.waiting) return t("pilot.state.waiting");
  return t(progress.held ? "pilot.state.held" : "pilot.state.simulating");
}

/** How far it is: its stage, and the time left of that if it is known. */
export function courseOf(t: Translate, { progress }: Pilot): string {
  if (progress === null) return "";
  if (progress.waiting) return t("pilot.waiting");
  if (progress.held) return t("pilot.held");
  const { stage, done, total, remaining_s } = progress;
  if (total === 0) return t("pilot.starting");
  const words = t(`pilot.stage.${stage}`, { done, total });
  return remaining_s === null || done === total
    ? words
    : `${words}, ${t("pilot.stage.left", { time: duration(seconds(Math.ceil(remaining_s))) })}`;
}
