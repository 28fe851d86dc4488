/**
 * The state of the tour: its current step, and whether it was seen, since it starts automatically
 * only once.
 */
import { useSyncExternalStore } from "react";

const KEY = "reembody.tour.seen";
let step: number | null = null;
const listeners = new Set<() => void>();

function turnTo(next: number | null): void {
  step = next;
  for (const listener of listeners) listener();
}

export const wasSeen = (): boolean => localStorage.getItem(KEY) !== null;
export const startTour = (): void => turnTo(0);

export function endTour(): void {
  localStorage.setItem(KEY, "1");
  turnTo(null);
}

export function turnTour(by: 1 | -1): void {
  if (step === null) return;
  const next = step + by;
  if (next >= TOUR_STEPS.length) endTour();
  else if (next >= 0) turnTo(next);
}

/** The number of the step that is shown, or null. */
export function useTourStep(): number | null {
  return useSyncExternalStore(
    (listener) => {
      listeners.add(listener);
      return () => listeners.delete(listener);
    },
    () => step,
  );
}

/** The side of its target on which a step's callout is shown. */
type Side = "top" | "right" | "bottom" | "left";

export interface TourStep {
  readonly key: "timeline" | "clock" | "next" | "live" | "tablet" | "alarms" | "replay" | "csv";
  /** The `data-tour` marks of possible targets; the first one on the page is used. */
  readonly marks: readonly string[];
  readonly side: Side;
}

export const TOUR_STEPS: readonly TourStep[] = [
  { key: "timeline", marks: ["timeline"], side: "right" },
  { key: "clock", marks: ["clock", "step"], side: "bottom" },
  { key: "next", marks: ["next", "step"], side: "bottom" },
  { key: "live", marks: ["live", "centre"], side: "top" },
  { key: "tablet", marks: ["devices", "side"], side: "left" },
  { key: "alarms", marks: ["signal"], side: "bottom" },
  { key: "replay", marks: ["replay", "head"], side: "bottom" },
  { key: "csv", marks: ["csv", "downloads"], side: "bottom" },
];

export const anchorOf = (step: TourStep): HTMLElement | null => {
  for (const mark of step.marks) {
    const found = document.querySelector<HTMLElement>(`[data-tour="${mark}"]`);
    if (found !== null) return found;
  }
  return null;
};
