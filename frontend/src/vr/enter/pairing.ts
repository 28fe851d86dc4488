/**
 * The session that this headset is paired with, kept so that a reload or a killed page continues.
 *
 * The token opens this session's socket and nothing else. It stays in the browser's storage until
 * the server rejects it or another code is used.
 */
import { ApiError, answer, server } from "@shared/api/request";
import { rememberEarlier } from "./earlier";

export interface Pairing {
  readonly sessionId: string;
  readonly token: string;
  /** The code that was used for it: its link leads here again, though a code works once. */
  readonly code?: string;
}

const KEY = "reembody.vr.pairing";

/** The pairing of this browser; null if there is none. */
export function storedPairing(storage: Pick<Storage, "getItem"> = localStorage): Pairing | null {
  try {
    const { sessionId, token, code } = JSON.parse(storage.getItem(KEY) ?? "null") ?? {};
    if (typeof sessionId !== "string" || typeof token !== "string") return null;
    return { sessionId, token, ...(typeof code === "string" && { code }) };
  } catch {
    return null;
  }
}

/** Keep a pairing; that of another session is kept among the earlier ones. */
export function storePairing(pairing: Pairing, storage: Storage = localStorage): void {
  const before = storedPairing(storage);
  if (before !== null && before.sessionId !== pairing.sessionId) rememberEarlier(before, storage);
  storage.setItem(KEY, JSON.stringify(pairing));
}

/** `isRefused`: the server does not know it any more; else it may still have something to send. */
export function forgetPairing(isRefused: boolean, storage: Storage = localStorage): void {
  const before = storedPairing(storage);
  if (before !== null && !isRefused) rememberEarlier(before, storage);
  storage.removeItem(KEY);
}

interface Paired {
  readonly device: string;
  readonly session_id: string;
  readonly token: string | null;
}

/**
 * Use a code, once. Throws ApiError if the server rejects it or it belongs to a tablet (with the
 * code `wrong_device`), and Unreachable without an answer.
 */
export async function pair(code: string, name: string): Promise<Pairing> {
  const paired = await answer<Paired>(server.POST("/api/devices/pair", { body: { code, name } }));
  if (paired.token === null) {
    throw new ApiError(409, { code: "wrong_device", message: "the code belongs to a tablet" });
  }
  return { sessionId: paired.session_id, token: paired.token, code };
}
