/**
 * The session that this headset is paired with, kept so that a reload or a killed page continues.
 *
 * The token opens this session's socket and nothing else. It stays in the browser's storage until
 * the server rejects it. When another code is used, it is kept among those of earlier sessions, until
 * what they left on this headset is sent.
 */
import { ApiError, answer, server } from "@shared/api/request";

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
export function storePairing(pairing: Pairing, storage: Kept = localStorage): void {
  const before = storedPairing(storage);
  if (before !== null && before.sessionId !== pairing.sessionId) rememberEarlier(before, storage);
  storage.setItem(KEY, JSON.stringify(pairing));
}

/** `isRefused`: the server does not know it any more; else it may still have something to send. */
export function forgetPairing(isRefused: boolean, storage: Kept = localStorage): void {
  const before = storedPairing(storage);
  if (before !== null && !isRefused) rememberEarlier(before, storage);
  storage.removeItem(KEY);
}

const EARLIER = "reembody.vr.earlier";
/** The oldest are forgotten beyond so many; a headset has one session at a time. */
const MOST = 50;

type Kept = Pick<Storage, "getItem" | "setItem" | "removeItem">;

/** The sessions that may have something left, oldest first. */
export function earlierPairings(storage: Kept = localStorage): readonly Pairing[] {
  try {
    const stored: unknown = JSON.parse(storage.getItem(EARLIER) ?? "[]");
    if (!Array.isArray(stored)) return [];
    return stored.filter(
      (one): one is Pairing => typeof one?.sessionId === "string" && typeof one?.token === "string",
    );
  } catch {
    return [];
  }
}

/** Keep a pairing that another one replaces. */
export function rememberEarlier(pairing: Pairing, storage: Kept = localStorage): void {
  const others = earlierPairings(storage).filter((one) => one.sessionId !== pairing.sessionId);
  const { sessionId, token } = pairing;
  storage.setItem(EARLIER, JSON.stringify([...others, { sessionId, token }].slice(-MOST)));
}

export function forgetEarlier(sessionId: string, storage: Kept = localStorage): void {
  const rest = earlierPairings(storage).filter((one) => one.sessionId !== sessionId);
  if (rest.length === 0) storage.removeItem(EARLIER);
  else storage.setItem(EARLIER, JSON.stringify(rest));
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
