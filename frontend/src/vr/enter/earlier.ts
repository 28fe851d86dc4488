/**
 * Sessions that this headset took part in before, of which it may still have something to send.
 *
 * Whatever a headset could not send (its network had failed, and the next participant came) stays on
 * it. The token of that session still opens it, so the page keeps the token and sends the rest as
 * soon as it is opened again, without anybody pairing the headset back. Once nothing is left, or the
 * participant has withdrawn, the session is forgotten with all that was kept of it.
 */
import { deliver } from "@shared/forms/deliver";
import { openForms, StoredForms } from "@shared/forms/storedForms";
import { deskOf, HEADSET_FORMS } from "../session/panels/desk";
import {
  deleteJournal,
  leftJournals,
  openTelemetry,
  TelemetryError,
  type TelemetryOptions,
} from "../telemetry";
import { earlierPairings, forgetEarlier, type Pairing } from "./pairing";

/** Whether a session has nothing left here, or could not be reached, or does not know its token. */
export type Sent = "nothing_left" | "unreachable" | "unpaired";

/**
 * Send what earlier sessions left, one after the other; `current` is that of the page itself, which
 * sends its own.
 */
export async function sendEarlier(
  current: string | null,
  optionsFor: (pairing: Pairing) => TelemetryOptions,
  send = sendLeft,
): Promise<void> {
  for (const pairing of earlierPairings()) {
    if (pairing.sessionId === current) continue;
    const sent = await send(pairing, optionsFor(pairing));
    // A token that was revoked opens nothing any more: only pairing with that session again helps.
    if (sent !== "unreachable") forgetEarlier(pairing.sessionId);
  }
}

async function sendLeft(pairing: Pairing, options: TelemetryOptions): Promise<Sent> {
  const forms = await sendForms(pairing);
  if (forms !== "nothing_left") return forms;
  const left = await leftJournals().catch(() => []);
  if (!left.some(({ storageKey }) => storageKey === pairing.sessionId)) return "nothing_left";
  return sendJournal(options);
}

async function sendForms({ sessionId, token }: Pairing): Promise<Sent> {
  const store = new StoredForms(openForms(HEADSET_FORMS));
  try {
    const desk = deskOf(token);
    for (const { id, queued } of await store.waiting(sessionId)) {
      if (queued === null) continue;
      const { kind } = await deliver(store, id, queued, (answers) => desk.submit(answers));
      if (kind === "unpaired") return "unpaired";
      if (kind === "later" || kind === "held" || kind === "refused") return "unreachable";
    }
    return "nothing_left";
  } finally {
    await store.close();
  }
}

/** As long as a server that is away is waited for; the next opening of the page tries again. */
const PATIENCE_MS = 60_000;

async function sendJournal(options: TelemetryOptions): Promise<Sent> {
  try {
    const client = await openTelemetry(options, { signal: AbortSignal.timeout(PATIENCE_MS) });
    try {
      await client.drained();
    } finally {
      await client.close();
    }
    return "nothing_left";
  } catch (error) {
    const code = error instanceof TelemetryError ? error.failure.code : "";
    if (code === "withdrawn") return "nothing_left";
    return code === "not_signed_in" || code === "closed_4401" ? "unpaired" : "unreachable";
  }
}

/** Delete everything that this headset has of a session: its participant has withdrawn. */
export async function discardSession(sessionId: string): Promise<void> {
  forgetEarlier(sessionId);
  await discardForms(sessionId);
  await deleteJournal(sessionId);
}

/** Delete the forms of a session, while its connection is still open. */
export async function discardForms(sessionId: string): Promise<void> {
  const store = new StoredForms(openForms(HEADSET_FORMS));
  try {
    await store.forgetSession(sessionId);
  } finally {
    await store.close();
  }
}
