/** The kinds of steps: their names, their icons, what is done in them, and why they pause. */
import type { Limb, PhaseSummary, SessionView, Step, StepKind } from "@shared/api/types";
import { latency } from "@shared/format";
import type { IconName } from "@shared/ui/Icon";
import { milliseconds } from "@shared/units";
import { type Key, useTexts } from "./i18n";
import { STEP_KINDS } from "./i18n/registries.generated";

/**
 * `limbs`: those it is done with, at the boxes; empty if it needs none. `counts`: its phases are
 * the study's data. `isCompletedByButton`: the experimenter completes it with a plain button.
 */
interface StepKindSpec {
  readonly family: "timed" | "form" | "by hand";
  readonly icon: IconName;
  readonly limbs: readonly Limb[];
  readonly counts: boolean;
  readonly isCompletedByButton: boolean;
}

const KINDS: Readonly<Record<StepKind, StepKindSpec>> = STEP_KINDS;

type Named = Pick<Step, "kind" | "limb">;
type OfKind = Pick<Step, "kind">;

/** The limb that a step is done with, at the boxes; null if its kind needs none. */
const limbOf = ({ kind, limb }: Named): Limb | null =>
  limb !== null && KINDS[kind].limbs.includes(limb) ? limb : null;

/** The key of the step's text of this group, such as `step` for its name. */
export function stepText(group: "step" | "guide" | "do.begin", step: Named): Key {
  const limb = limbOf(step);
  return (limb === null ? `${group}.${step.kind}` : `${group}.${step.kind}.${limb}`) as Key;
}

export const stepName = (step: Named): Key => stepText("step", step);

export const stepIcon = (step: Named): IconName => limbOf(step) ?? KINDS[step.kind].icon;

/** Whether a step runs on the phase clock, in the headset. */
export const isTimed = ({ kind }: OfKind): boolean => KINDS[kind].family === "timed";

/** Whether a step is answered at the tablet (or read out by the operator). */
export const isForm = ({ kind }: OfKind): boolean => KINDS[kind].family === "form";

/** Whether a step's phases are the study's data; all others are in no figure or test. */
export const isCounted = ({ kind }: OfKind): boolean => KINDS[kind].counts;

/** Whether the experimenter completes a step with a plain button; height and consent have forms. */
export const isCompletedByButton = ({ kind }: OfKind): boolean => KINDS[kind].isCompletedByButton;

/** Whether a phase is over, done or voided. */
export const isOver = ({ status }: PhaseSummary): boolean =>
  status === "done" || status === "voided";

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
] as const;

/** The key of the text for why a phase's clock was paused; null for a reason in a person's words. */
export function causeKey(reason: string | null): Key | null {
  const match = CAUSES.find((cause) => cause === reason);
  return match === undefined ? null : `cause.${match}`;
}
