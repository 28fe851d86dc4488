/** What an operator presses next in a session, as the cockpit and the page on a screen show it. */
import type { Command, CommandType, Device, SessionView, Step } from "@shared/api/types";
import type { IconName } from "@shared/ui/Icon";
import { isCompletedByButton, type RegistryKey, stepText } from "./steps";
import type { actionsEn } from "./texts";

export type ActionKey = RegistryKey | keyof typeof actionsEn;

export interface PrimaryAction {
  readonly command: Command;
  readonly label: ActionKey;
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
    return { command, label: `do.complete.${step.kind}` as ActionKey, icon: "check" };
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

export const isConnected = ({ devices }: SessionView, device: Device): boolean =>
  devices.some(({ kind, connected }) => kind === device && connected);
