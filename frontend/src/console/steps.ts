/** Names and signs of the steps of a procedure. */
import type { PhaseSummary, SessionView, Step } from "@shared/api/types";
import { latency } from "@shared/format";
import type { IconName } from "@shared/ui/Icon";
import { milliseconds } from "@shared/units";
import { type Key, useTexts } from "./i18n";

const STEP_ICONS: Readonly<Record<string, IconName>> = {
  consent: "check",
  form: "form",
  instructions: "talk",
  height: "height",
  materialise: "body",
  free_roam: "walk",
  practice: "hand",
  task: "hand",
  questionnaire: "form",
  debrief: "flag",
};

const NAMES = new Set([
  "consent",
  "form",
  "instructions",
  "height",
  "materialise",
  "free_roam",
  "questionnaire",
  "debrief",
]);

/** The text key of a kind of step; an unknown kind is called a step. */
export function stepNameKey(kind: string): Key {
  return (NAMES.has(kind) ? `step.${kind}` : "step.other") as Key;
}

type Named = Pick<Step, "kind" | "limb">;

/** Steps that are done with a hand or a foot, at the boxes. */
const hasBoxes = (kind: string): kind is "task" | "practice" =>
  kind === "task" || kind === "practice";

export const stepName = ({ kind, limb }: Named): Key =>
  hasBoxes(kind) && limb !== null ? `step.${kind}.${limb}` : stepNameKey(kind);

export const stepIcon = ({ kind, limb }: Named): IconName =>
  hasBoxes(kind) && limb !== null ? limb : (STEP_ICONS[kind] ?? "flag");

/** Steps that run on the phase clock, in the headset. */
export const isTimed = (step: Pick<Step, "kind">): boolean =>
  hasBoxes(step.kind) || step.kind === "free_roam";

/** Steps that are answered at the tablet (or read out by the operator). */
export const isForm = (step: Pick<Step, "kind">): boolean =>
  step.kind === "form" || step.kind === "questionnaire";

/** How the phases of a session are named: block, task, and the latency where it may be known. */
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
