/**
 * The kinds of a session's steps, and their words. Generated from `app/protocol/step_kinds.py`:
 *
 *     python -m app.protocol > frontend/src/console/stepKinds.generated.ts
 */
import type { Limb, StepKind } from "@shared/api/types";
import type { IconName } from "@shared/ui/Icon";

/**
 * `limbs`: those it is done with, at the boxes; none where it needs none. `counts`: its phases are
 * the study's data. `isCompletedByButton`: the experimenter ends it with a plain button.
 */
export interface StepKindSpec {
  readonly family: "timed" | "form" | "by hand";
  readonly icon: IconName;
  readonly limbs: readonly Limb[];
  readonly counts: boolean;
  readonly isCompletedByButton: boolean;
}

export const STEP_KINDS: Readonly<Record<StepKind, StepKindSpec>> = {
  consent: { family: "by hand", icon: "check", limbs: [], counts: false, isCompletedByButton: false },
  form: { family: "form", icon: "form", limbs: [], counts: false, isCompletedByButton: false },
  instructions: { family: "by hand", icon: "talk", limbs: [], counts: false, isCompletedByButton: true },
  height: { family: "by hand", icon: "height", limbs: [], counts: false, isCompletedByButton: false },
  materialise: { family: "by hand", icon: "body", limbs: [], counts: false, isCompletedByButton: false },
  free_roam: { family: "timed", icon: "walk", limbs: [], counts: false, isCompletedByButton: false },
  practice: { family: "timed", icon: "hand", limbs: ["hand", "foot"], counts: false, isCompletedByButton: false },
  task: { family: "timed", icon: "hand", limbs: ["hand", "foot"], counts: true, isCompletedByButton: false },
  questionnaire: { family: "form", icon: "form", limbs: [], counts: false, isCompletedByButton: false },
  debrief: { family: "by hand", icon: "flag", limbs: [], counts: false, isCompletedByButton: true },
};

export const stepKindsEn = {
  "step.consent": "Consent",
  "guide.consent": "The participant reads and agrees on the tablet. Record it here only if consent was given on paper.",
  "step.form": "Questions",
  "guide.form": "The participant answers on the tablet.",
  "step.instructions": "Instructions",
  "guide.instructions": "The participant reads on the tablet. Invite questions before going on.",
  "do.complete.instructions": "Instructions are clear",
  "step.height": "Height",
  "guide.height": "Ask for the height, then match the avatar by eye. Both values are kept.",
  "step.materialise": "Entering the body",
  "guide.materialise": "The participant stands inside the transparent body in a T-pose and presses both grips.",
  "step.free_roam": "Free movement",
  "guide.free_roam": "Let the participant look around, down at the body and into the mirror.",
  "do.begin.free_roam": "Begin free movement",
  "step.practice": "Practice",
  "step.practice.hand": "Practice with the hand",
  "guide.practice.hand": "A task to try out, which is not analysed. Let the participant ask questions.",
  "do.begin.practice.hand": "Begin practice",
  "step.practice.foot": "Practice with the foot",
  "guide.practice.foot": "A task to try out, which is not analysed. Let the participant ask questions.",
  "do.begin.practice.foot": "Begin practice",
  "step.task": "Task",
  "step.task.hand": "Hand task",
  "guide.task.hand": "Make sure that the participant stands on the start square and uses the writing hand, then begin.",
  "do.begin.task.hand": "Begin hand task",
  "step.task.foot": "Foot task",
  "guide.task.foot": "Make sure that the participant stands on the start square, then begin.",
  "do.begin.task.foot": "Begin foot task",
  "step.questionnaire": "Questionnaire",
  "guide.questionnaire": "The participant answers on the tablet, or you read the items aloud and enter the answers.",
  "step.debrief": "Debriefing",
  "guide.debrief": "Help the participant out of the headset and explain what the study was about.",
  "do.complete.debrief": "Finish session",
  "validity.phase.free_roam": "free movement",
  "validity.phase.practice_hand": "practice with the hand",
  "validity.phase.practice_foot": "practice with the foot",
  "validity.phase.hand": "hand task",
  "validity.phase.foot": "foot task",
};

export const stepKindsDe: Readonly<Record<keyof typeof stepKindsEn, string>> = {
  "step.consent": "Einwilligung",
  "guide.consent": "Die Person liest und willigt am Tablet ein. Hier nur festhalten, wenn auf Papier eingewilligt wurde.",
  "step.form": "Fragen",
  "guide.form": "Die Person antwortet am Tablet.",
  "step.instructions": "Anleitung",
  "guide.instructions": "Die Person liest am Tablet. Laden Sie zu Fragen ein, bevor es weitergeht.",
  "do.complete.instructions": "Anleitung ist klar",
  "step.height": "Körpergröße",
  "guide.height": "Fragen Sie nach der Größe und gleichen Sie den Avatar nach Augenmaß an. Beide Werte bleiben erhalten.",
  "step.materialise": "Eintritt in den Körper",
  "guide.materialise": "Die Person steht in T-Haltung im durchsichtigen Körper und drückt beide Griffe.",
  "step.free_roam": "Freies Bewegen",
  "guide.free_roam": "Lassen Sie die Person umherschauen, an sich hinab und in den Spiegel.",
  "do.begin.free_roam": "Freies Bewegen beginnen",
  "step.practice": "Übung",
  "step.practice.hand": "Übung mit der Hand",
  "guide.practice.hand": "Eine Aufgabe zum Ausprobieren, die nicht ausgewertet wird. Ermuntern Sie zu Fragen.",
  "do.begin.practice.hand": "Übung beginnen",
  "step.practice.foot": "Übung mit dem Fuß",
  "guide.practice.foot": "Eine Aufgabe zum Ausprobieren, die nicht ausgewertet wird. Ermuntern Sie zu Fragen.",
  "do.begin.practice.foot": "Übung beginnen",
  "step.task": "Aufgabe",
  "step.task.hand": "Handaufgabe",
  "guide.task.hand": "Achten Sie darauf, dass die Person auf dem Startfeld steht und die Schreibhand benutzt; dann beginnen Sie.",
  "do.begin.task.hand": "Handaufgabe beginnen",
  "step.task.foot": "Fußaufgabe",
  "guide.task.foot": "Achten Sie darauf, dass die Person auf dem Startfeld steht; dann beginnen Sie.",
  "do.begin.task.foot": "Fußaufgabe beginnen",
  "step.questionnaire": "Fragebogen",
  "guide.questionnaire": "Die Person antwortet am Tablet, oder Sie lesen vor und geben die Antworten ein.",
  "step.debrief": "Abschluss",
  "guide.debrief": "Helfen Sie der Person aus dem Headset und erklären Sie, worum es in der Studie ging.",
  "do.complete.debrief": "Sitzung abschließen",
  "validity.phase.free_roam": "freies Bewegen",
  "validity.phase.practice_hand": "Übung mit der Hand",
  "validity.phase.practice_foot": "Übung mit dem Fuß",
  "validity.phase.hand": "Handaufgabe",
  "validity.phase.foot": "Fußaufgabe",
};
