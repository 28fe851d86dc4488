/** Which step an operator most likely wants done over. */
import type { SessionView, Step } from "@shared/api/types";
import { isTimed } from "../../steps";

/**
 * The current step while its phase is under way; else the task before it, because that is what goes
 * wrong; else the step before. Everything from that step on is then done over.
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

/** The steps that can be done over: those behind, and the current one once it has begun. */
export function redoable(session: SessionView): readonly Step[] {
  const { current, steps } = session;
  if (current === null) return [];
  const step = steps[current.index];
  const begun = current.status !== "ready" || (step !== undefined && isTimed(step));
  return steps.slice(0, begun ? current.index + 1 : current.index);
}
