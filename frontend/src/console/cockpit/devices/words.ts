/** What the person at a connected device is doing, as far as the session knows it. */
import type { Device, SessionView } from "@shared/api/types";
import { isForm, isTimed } from "../../steps";
import { currentStep } from "../session/action";

export type Doing =
  | "declined"
  | "asking"
  | "calling"
  | "stopping"
  | "reading"
  | "answering"
  | "moving"
  | "paused"
  | "waiting";

const IN_A_PHASE: readonly string[] = ["preparing", "running", "walk_back", "freezing"];

/** Null where nothing can be said: no step is current, as before the start and after the end. */
export function doing(session: SessionView, device: Device): Doing | null {
  const isOn = (code: string) =>
    session.alarms.some((alarm) => alarm.code === code && alarm.cleared_at === null);
  const step = currentStep(session);
  if (device === "tablet") {
    if (session.refusal !== null) return "declined";
    if (isOn("question_asked")) return "asking";
    if (isOn("help_asked")) return "calling";
  } else if (isOn("stop_asked")) return "stopping";
  if (step === null || session.current === null) return null;
  const { status } = session.current;
  if (device === "headset" && isTimed(step)) {
    if (status === "paused") return "paused";
    return IN_A_PHASE.includes(status) ? "moving" : "waiting";
  }
  const isHere = step.forms === device;
  if (device === "tablet" && step.kind === "consent") return "reading";
  return isForm(step) && isHere ? "answering" : "waiting";
}
