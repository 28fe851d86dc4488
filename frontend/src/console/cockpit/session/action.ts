/**
 * Derive from the session what an operator does next, which commands need a reason, and which steps
 * can be repeated.
 */
import type { Command, CommandType, Device, SessionView, Step } from "@shared/api/types";
import type { IconName } from "@shared/ui/Icon";
import type { Key } from "../../i18n";
import { isCompletedByButton, isForm, isTimed, stepText } from "../../steps";

interface PrimaryAction {
  readonly command: Command;
  readonly label: Key;
  readonly icon: IconName;
}

/** The current step; null before the start and after the end. */
export function currentStep(session: SessionView): Step | null {
  return session.current === null ? null : (session.steps[session.current.index] ?? null);
}

/**
 * The primary action, or null when the next move is not the operator's: the tablet is being filled
 * in, the headset counts down, or the session is over. Height is not included, because it has its
 * own form; nor is consent, which only the participant can give and which takes more than one press
 * on paper, too.
 */
export function primaryAction(session: SessionView): PrimaryAction | null {
  const may = (type: Command["type"]): boolean => session.allowed.includes(type);
  const step = currentStep(session);
  if (may("start")) return { command: { type: "start" }, label: "do.start", icon: "play" };
  if (step === null) return null;
  if (may("resume")) return { command: { type: "resume" }, label: "do.resume", icon: "play" };
  if (may("begin_phase")) {
    return { command: { type: "begin_phase" }, label: stepText("do.begin", step), icon: "play" };
  }
  if (may("materialise")) {
    return { command: { type: "materialise" }, label: "do.materialise", icon: "body" };
  }
  if (may("complete_step") && isCompletedByButton(step)) {
    const command: Command = { type: "complete_step", step_index: step.index };
    return { command, label: `do.complete.${step.kind}` as Key, icon: "check" };
  }
  return null;
}

const NEEDS_HEADSET: readonly CommandType[] = ["materialise", "begin_phase", "resume"];

const needsHeadset = (type: string): boolean => NEEDS_HEADSET.some((one) => one === type);

/**
 * Whether the server would refuse the next action because no headset is connected to carry it out.
 */
export const lacksHeadset = (session: SessionView): boolean =>
  session.allowed.some(needsHeadset) && !isConnected(session, "headset");

/** Whether the primary action has to wait until a headset is connected. */
export const isBlocked = (session: SessionView, { command }: PrimaryAction): boolean =>
  needsHeadset(command.type) && !isConnected(session, "headset");

/** Whether the session cannot go on without a headset, be it an action or a form that waits. */
export const awaitsHeadset = (session: SessionView): boolean =>
  lacksHeadset(session) ||
  (currentStep(session)?.forms === "headset" && !isConnected(session, "headset"));

export const isConnected = ({ devices }: SessionView, device: Device): boolean =>
  devices.some(({ kind, connected }) => kind === device && connected);

/** The instruction for the operator: what to say or do now. */
export function guidance(session: SessionView): Key {
  const step = currentStep(session);
  if (session.status === "completed" && session.simulated) return "guide.completed.simulated";
  if (session.status !== "active" && session.status !== "planned") return `guide.${session.status}`;
  if (step === null || session.current === null) return "guide.planned";
  if (session.current.status !== "ready") return `guide.${session.current.status}`;
  return isForm(step) && step.forms === "headset" ? "step.askInHeadset" : stepText("guide", step);
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
