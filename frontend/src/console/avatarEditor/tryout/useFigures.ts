/** What is told in words while a simulation runs: read some times a second, not for every picture. */
import { useInterval } from "@mantine/hooks";
import { useState } from "react";
import type { TryoutRun } from "./run";

const EVERY_MS = 250;

/** Return what `read` finds in the run; `before` there is none. */
export function useFigures<T>(run: TryoutRun | null, read: (run: TryoutRun) => T, before: T): T {
  const [found, setFound] = useState(before);
  useInterval(
    () => {
      if (run !== null) setFound(read(run));
    },
    EVERY_MS,
    { autoInvoke: true },
  );
  return found;
}
