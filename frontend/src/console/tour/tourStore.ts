/** Whether the tour is on, where it stands, and that it was seen: it begins by itself only once. */
import { useSyncExternalStore } from "react";
import { TOUR_STEPS } from "./tourSteps";

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
