/** The part of a run that is state of the page. */
import { useSyncExternalStore } from "react";
import type { RunState, TryoutRun } from "./run";

export const useRunState = (run: TryoutRun | null): RunState | null =>
  useSyncExternalStore(run?.subscribe ?? NEVER, () => run?.state ?? null);
const NEVER = () => () => {};
