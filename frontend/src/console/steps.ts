/** How phases are named, and why they pause; what is the same on all pages is shared. */
import type { PhaseSummary, SessionView } from "@shared/api/types";
import { latency } from "@shared/format";
import { isOver, stepName } from "@shared/session/steps";
import { milliseconds } from "@shared/units";
import { type Key, useTexts } from "./i18n";

export {
  isCompletedByButton,
  isCounted,
  isForm,
  isOver,
  isTimed,
  stepIcon,
  stepName,
  stepText,
} from "@shared/session/steps";

/** Return a function that names a phase: its block, its task, and its latency if it may be known. */
export function usePhaseName(): (session: SessionView, phase: PhaseSummary) => string {
  const { t } = useTexts();
  return (session, phase) => {
    const block = session.steps[phase.step_index]?.block ?? null;
    return [
      block === null ? null : t("replay.phase.block", { number: block }),
      t(stepName(phase)),
      phase.latency_ms === null ? null : latency(milliseconds(phase.latency_ms)),
      phase.body,
      phase.attempt > 1 ? t("timeline.attempt", { number: phase.attempt }) : null,
      phase.status === "voided" ? t("replay.phase.void") : null,
      isOver(phase) ? null : t("replay.phase.running"),
    ]
      .filter((part) => part !== null)
      .join(" · ");
  };
}

const CAUSES = [
  "operator",
  "headset_lost",
  "headset_silent",
  "server_restarted",
  "headset",
  "road",
] as const;

/** The key of the text for why a phase's clock was paused; null for a reason in a person's words. */
export function causeKey(reason: string | null): Key | null {
  const match = CAUSES.find((cause) => cause === reason);
  return match === undefined ? null : `cause.${match}`;
}
