/** A consent that is being given: its lines and its signature, also after the browser was killed. */
import type { TabletState } from "@shared/api/types";
import { useEffect, useRef, useState } from "react";
import { type Signing, UNSIGNED } from "../screens/signed";
import { drafts } from "./useKeptForm";

/** A stroke changes it many times a second. */
const KEEP_AFTER_MS = 150;

export function useKeptSigning(
  state: TabletState,
): readonly [signing: Signing, change: (signing: Signing) => void] {
  const [signing, setSigning] = useState<Signing>(UNSIGNED);
  const touched = useRef(false);
  const timer = useRef<ReturnType<typeof setTimeout>>(undefined);
  // biome-ignore lint/correctness/useExhaustiveDependencies: a consent's page is mounted anew for each step
  useEffect(() => {
    void drafts.signing(state).then((kept) => {
      if (kept !== undefined && !touched.current) setSigning(kept);
    });
    return () => clearTimeout(timer.current);
  }, []);
  const change = (next: Signing): void => {
    touched.current = true;
    setSigning(next);
    clearTimeout(timer.current);
    timer.current = setTimeout(() => void drafts.keepSigning(state, next), KEEP_AFTER_MS);
  };
  return [signing, change];
}
