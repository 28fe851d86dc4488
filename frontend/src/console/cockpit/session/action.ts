/**
 * Derive from the session what an operator may do, which commands need a reason, and which steps
 * can be repeated.
 */

import type { CommandType, SessionView, Step } from "@shared/api/types";
import { currentStep, isConnected, lacksHeadset } from "@shared/session/nextAction";
import { isCrossing } from "@shared/session/steps";
import type { Key } from "../../i18n";
import { isForm, isTimed, stepText } from "../../steps";

export {
  currentStep,
  isBlocked,
  isConnected,
  lacksHeadset,
  primaryAction,
} from "@shared/session/nextAction";

/** Whether the session cannot go on without a headset, be it an action or a form that waits. */
export const awaitsHeadset = (session: SessionView): boolean =>
  lacksHeadset(session) ||
  (currentStep(session)?.forms === "headset" && !isConnected(session, "headset"));

/** The instruction for the operator: what to say or do now. */
export function guidance(session: SessionView): Key {
  const step = currentStep(session);
  if (session.status === "completed" && session.simulated) return "guide.completed.simulated";
  if (session.status !== "active" && session.status !== "planned") return `guide.${session.status}`;
  if (step === null || session.current === null) return guidanceBeforeStart(session);
  const { status } = session.current;
  if (isCrossing(step) && (status === "preparing" || status === "running")) {
    return `guide.${status}.road`;
  }
  if (status !== "ready") return `guide.${status}`;
  return isForm(step) && step.forms === "headset" ? "step.askInHeadset" : stepText("guide", step);
}

/** Which devices are missing before the start, if any. */
function guidanceBeforeStart(session: SessionView): Key {
  const hasTablet = isConnected(session, "tablet");
  const hasHeadset = isConnected(session, "headset");
  if (hasTablet && hasHeadset) return "guide.planned.connected";
  if (hasTablet) return "guide.planned.headset";
  return hasHeadset ? "guide.planned.tablet" : "guide.planned";
}

/** Why the headset shows no companion now; `moment`: for something that the steps do not tell. */
export function hiddenBecause(
  session: SessionView,
  inTasks: boolean,
): "body" | "task" | "road" | "moment" {
  const { current, steps } = session;
  const appears = steps.findIndex(({ kind }) => kind === "materialise");
  if (current === null || current.index <= appears) return "body";
  const step = currentStep(session);
  if (step !== null && isCrossing(step)) return "road";
  return !inTasks && step !== null && isTimed(step) && step.limb !== null ? "task" : "moment";
}

export type Reasoned = Extract<
  CommandType,
  "redo" | "skip" | "abort" | "withdraw" | "override_stop" | "reopen_consent"
>;

/** Frequent reasons, each one click away. */
export const COMMON_REASONS: Readonly<Record<Reasoned | "pause", readonly Key[]>> = {
  pause: ["reason.break", "reason.tracking", "reason.question", "reason.unwell"],
  redo: ["reason.tracking", "reason.misunderstood", "reason.interrupted"],
  skip: ["reason.askedAloud", "reason.time", "reason.wish"],
  abort: ["reason.equipment", "reason.time", "reason.interrupted", "reason.stopRule"],
  override_stop: ["reason.recovered", "reason.mistyped"],
  reopen_consent: ["reason.changedMind", "reason.misread"],
  withdraw: ["reason.refused", "reason.wish", "reason.sick", "reason.unwell"],
};

/**
 * The step that an operator most likely wants to repeat.
 *
 * The current step while its phase is running; otherwise the task before it, because that is what
 * goes
 * wrong; otherwise the previous step. Everything from that step on is then repeated.
 */
export function redoTarget(session: SessionView): number {
  const { current, steps } = session;
  if (current === null) return 0;
  if (current.status !== "ready") return current.index;
  const before = steps.slice(0, current.index);
  const block = steps[current.index]?.block ?? null;
  const task = before.findLast((step) => isTimed(step) && step.block === block);
  return task?.index ?? Math.max(0, current.index - 1);
}

/** The steps that can be repeated: the completed ones, and the current one once it has started. */
export function redoable(session: SessionView): readonly Step[] {
  const { current, steps } = session;
  if (current === null) return [];
  const step = steps[current.index];
  const hasStarted = current.status !== "ready" || (step !== undefined && isTimed(step));
  return steps.slice(0, hasStarted ? current.index + 1 : current.index);
}
