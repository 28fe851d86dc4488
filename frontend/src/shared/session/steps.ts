/** The kinds of steps: their names, their icons, and what is done in them. */
import type { Limb, PhaseSummary, Step, StepKind } from "@shared/api/types";
import type { IconName } from "@shared/ui/Icon";
import { type registryEn, STEP_KINDS } from "./registries.generated";

export type RegistryKey = keyof typeof registryEn;

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
export function stepText(group: "step" | "guide" | "do.begin", step: Named): RegistryKey {
  const limb = limbOf(step);
  return (limb === null ? `${group}.${step.kind}` : `${group}.${step.kind}.${limb}`) as RegistryKey;
}

export const stepName = (step: Named): RegistryKey => stepText("step", step);

export const stepIcon = (step: Named): IconName => limbOf(step) ?? KINDS[step.kind].icon;

/** Whether a step runs on the phase clock, in the headset. */
export const isTimed = ({ kind }: OfKind): boolean => KINDS[kind].family === "timed";

/** Whether a step is answered at the tablet (or read out by the operator). */
export const isForm = ({ kind }: OfKind): boolean => KINDS[kind].family === "form";

/** Whether a step's phases are the study's data; all others are in no figure or test. */
export const isCounted = ({ kind }: OfKind): boolean => KINDS[kind].counts;

/** Whether a step's phases are crossings of the road: the study's data, without boxes. */
export const isCrossing = ({ kind }: OfKind): boolean =>
  isTimed({ kind }) && isCounted({ kind }) && KINDS[kind].limbs.length === 0;

/** The kind of the steps that are crossings of the road. */
export const CROSSING = (Object.keys(KINDS) as StepKind[]).find((kind) =>
  isCrossing({ kind }),
) as StepKind;

/** Whether the experimenter completes a step with a plain button; height and consent have forms. */
export const isCompletedByButton = ({ kind }: OfKind): boolean => KINDS[kind].isCompletedByButton;

/** Whether a phase is over, done or voided. */
export const isOver = ({ status }: PhaseSummary): boolean =>
  status === "done" || status === "voided";
