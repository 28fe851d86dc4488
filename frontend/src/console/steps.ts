/** Names and signs of the steps of a procedure. */
import type { Step } from "@shared/api/types";
import type { IconName } from "@shared/ui/Icon";
import type { Key } from "./i18n";

export const STEP_ICONS: Readonly<Record<string, IconName>> = {
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
