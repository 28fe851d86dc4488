/** How the phases of a session are named: block, task, and the latency where it may be known. */
import type { PhaseSummary, SessionView } from "@shared/api/types";
import { latency } from "@shared/format";
import { milliseconds } from "@shared/units";
import { useTexts } from "../i18n";
import { stepName } from "../steps";

export const isOver = ({ status }: PhaseSummary): boolean =>
  status === "done" || status === "voided";

export function usePhaseName(): (session: SessionView, phase: PhaseSummary) => string {
  const { t } = useTexts();
  return (session, phase) => {
    const block = session.steps[phase.step_index]?.block ?? null;
    return [
      block === null ? null : t("replay.phase.block", { number: block }),
      t(stepName(phase)),
      phase.latency_ms === null ? null : latency(milliseconds(phase.latency_ms)),
      phase.attempt > 1 ? t("timeline.attempt", { number: phase.attempt }) : null,
      phase.status === "voided" ? t("replay.phase.void") : null,
      isOver(phase) ? null : t("replay.phase.running"),
    ]
      .filter((part) => part !== null)
      .join(" · ");
  };
}
