/** The body of a hash, loaded while a page shows it. Nothing is loaded for no hash. */
import type { BodyModel } from "@shared/stage/skin/bodyModel";
import { useCallback, useEffect, useState } from "react";

export interface BodyState {
  readonly state: "none" | "loading" | "ready" | "failed";
  readonly model: BodyModel | null;
  readonly error: Error | null;
  readonly retry: () => void;
}

type Loaded = Omit<BodyState, "retry">;

const NONE: Loaded = { state: "none", model: null, error: null };
const LOADING: Loaded = { state: "loading", model: null, error: null };

export function useBody(hash: string | null): BodyState {
  const [loaded, setLoaded] = useState<Loaded>(hash === null ? NONE : LOADING);
  const [attempt, setAttempt] = useState(0);
  // biome-ignore lint/correctness/useExhaustiveDependencies: another attempt loads it again.
  useEffect(() => {
    if (hash === null) {
      setLoaded(NONE);
      return;
    }
    setLoaded(LOADING);
    let isGone = false;
    let release = () => {};
    import("@shared/stage/skin/loadBody")
      .then(({ takeBody }) => {
        if (isGone) return null;
        const taken = takeBody(hash);
        release = taken.release;
        return taken.loading;
      })
      .then((model) => {
        if (!isGone && model !== null) setLoaded({ state: "ready", model, error: null });
      })
      .catch((error: unknown) => {
        const reason = error instanceof Error ? error : new Error(String(error));
        if (!isGone) setLoaded({ state: "failed", model: null, error: reason });
      });
    return () => {
      isGone = true;
      release();
    };
  }, [hash, attempt]);
  const retry = useCallback(() => setAttempt((before) => before + 1), []);
  return { ...loaded, retry };
}
