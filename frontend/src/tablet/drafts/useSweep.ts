/**
 * Forms that were sent while nobody could say whether they arrived.
 *
 * When the answer of the server is lost, the session may have moved on before this tablet knows. So
 * whenever it hears from the server again, what still waits is sent once more: the server knows the
 * key and confirms, and the tablet forgets. A form on the screen looks after itself.
 */
import { tablet } from "@shared/api/endpoints";
import type { TabletState } from "@shared/api/types";
import { useEffect } from "react";
import { deliver } from "./deliver";
import { drafts } from "./useKeptForm";

export function useSweep(state: TabletState, connected: boolean): void {
  const { session_id: sessionId, version } = state;
  const shown = state.administration?.key ?? null;
  // biome-ignore lint/correctness/useExhaustiveDependencies: a new version is a reason to look again
  useEffect(() => {
    if (connected) void sweep(sessionId, shown);
  }, [sessionId, version, shown, connected]);
}

async function sweep(sessionId: string, shown: string | null): Promise<void> {
  await drafts.forgetOld(new Date());
  for (const kept of await drafts.waiting(sessionId)) {
    if (kept.administration === shown || kept.queued === null) continue;
    await deliver(drafts, kept.id, kept.queued, tablet.submit);
  }
}
