/**
 * What a tablet needs to go on without a network, after its browser was killed (IndexedDB): what a
 * participant has entered but the server has not confirmed, and the screen that was shown last.
 *
 * A record goes through two states. A *draft* changes with every answer. *Queued*, its submission is
 * fixed, together with the idempotency key made when the form was first shown: however often it is
 * sent, after a lost answer or a reload, the server stores it once. The record is deleted when the
 * server has confirmed it, and not before.
 *
 * A refusal to take part waits in the same way until the server knows of it: the newest wish of a
 * session replaces the one before.
 *
 * The screen is the newest one of the session that the tablet is paired with; it goes with the end
 * of the session or of the pairing. A consent that somebody is about to give is kept with its lines
 * and its signature for as long as it is on the screen, and is never sent by itself.
 */
import type { RefusalWish, Submission, TabletState } from "@shared/api/types";
import { EMPTY_DRAFT, type FormDraft } from "@shared/forms/draft";
import { uuid } from "@shared/uuid";
import { type DBSchema, type IDBPDatabase, openDB } from "idb";
import type { Signing } from "../screens/signed";

export interface Kept {
  /** Session and administration: one form, filled in once. */
  readonly id: string;
  readonly sessionId: string;
  readonly administration: string;
  readonly idempotencyKey: string;
  readonly startedAt: string;
  readonly draft: FormDraft;
  /** The submission as it is sent; null while it is still being filled in. */
  readonly queued: Submission | null;
}

interface Tables extends DBSchema {
  kept: { key: string; value: Kept };
  screen: { key: string; value: TabletState };
  signing: { key: string; value: Signing };
  wish: { key: string; value: RefusalWish };
}

/** There is one screen. */
const LAST = "last";

const OLD_MS = 48 * 3_600_000;

export const keptId = (sessionId: string, administration: string): string =>
  `${sessionId}/${administration}`;

const signingKey = ({ session_id, step_index }: TabletState): string =>
  `${session_id}/${step_index}`;

export class DraftStore {
  readonly #database: Promise<IDBPDatabase<Tables>>;

  constructor(name = "reembody-tablet") {
    this.#database = openDB<Tables>(name, 4, {
      upgrade: (database, before) => {
        if (before < 1) database.createObjectStore("kept", { keyPath: "id" });
        if (before < 2) database.createObjectStore("screen");
        if (before < 3) database.createObjectStore("signing");
        if (before < 4) database.createObjectStore("wish");
      },
      // A page of a newer version waits to open it.
      blocking: (_current, _wanted, event) => (event.target as IDBDatabase).close(),
    });
  }

  /** What is kept of this form; a new record, with a key of its own, when there is nothing yet. */
  async open(sessionId: string, administration: string, now: Date): Promise<Kept> {
    const id = keptId(sessionId, administration);
    const database = await this.#database;
    const transaction = database.transaction("kept", "readwrite");
    const known = await transaction.store.get(id);
    const kept = known ?? {
      id,
      sessionId,
      administration,
      idempotencyKey: uuid(),
      startedAt: now.toISOString(),
      draft: EMPTY_DRAFT,
      queued: null,
    };
    if (known === undefined) await transaction.store.put(kept);
    await transaction.done;
    // An older version may have left it, with less in it.
    return { ...kept, draft: { ...EMPTY_DRAFT, ...kept.draft } };
  }

  /** Keep the newest answers; a form that is already queued or confirmed is left as it is. */
  async keep(id: string, draft: FormDraft): Promise<void> {
    const transaction = (await this.#database).transaction("kept", "readwrite");
    const known = await transaction.store.get(id);
    if (known !== undefined && known.queued === null) {
      await transaction.store.put({ ...known, draft });
    }
    await transaction.done;
  }

  /** Fix what will be sent. The first submission of a form stays the only one. */
  async queue(id: string, submission: Submission): Promise<Submission> {
    // Strict: on the disk, not only handed to the system, before the participant is told it is safe.
    const options = { durability: "strict" } as const;
    const transaction = (await this.#database).transaction("kept", "readwrite", options);
    const known = await transaction.store.get(id);
    if (known === undefined) throw new Error(`There is no draft ${id} on this tablet.`);
    const queued = known.queued ?? submission;
    await transaction.store.put({ ...known, queued });
    await transaction.done;
    return queued;
  }

  /** Take a queued form back to be edited: the server has looked at it and stored nothing. */
  async reopen(id: string): Promise<void> {
    const transaction = (await this.#database).transaction("kept", "readwrite");
    const known = await transaction.store.get(id);
    if (known !== undefined) await transaction.store.put({ ...known, queued: null });
    await transaction.done;
  }

  /** Everything that waits to be sent for this session. */
  async waiting(sessionId: string): Promise<readonly Kept[]> {
    const all = await (await this.#database).getAll("kept");
    return all.filter((kept) => kept.sessionId === sessionId && kept.queued !== null);
  }

  /** The server has it: nothing of it stays on the tablet, and its form is not shown again. */
  async forget(id: string): Promise<void> {
    const transaction = (await this.#database).transaction(["kept", "screen"], "readwrite");
    await transaction.objectStore("kept").delete(id);
    const screens = transaction.objectStore("screen");
    const last = await screens.get(LAST);
    if (last != null && id === keptId(last.session_id, last.administration?.key ?? "")) {
      await screens.put(waitingAfter(last), LAST);
    }
    await transaction.done;
  }

  /** Keep what the server wants to be shown; with the end of the session nothing more is. */
  async keepScreen(state: TabletState): Promise<void> {
    const tables = ["kept", "screen", "signing", "wish"] as const;
    const transaction = (await this.#database).transaction(tables, "readwrite");
    const signings = transaction.objectStore("signing");
    for (const key of await signings.getAllKeys()) {
      // It was given, or nobody asks for it any more.
      if (state.screen !== "consent" || key !== signingKey(state)) await signings.delete(key);
    }
    const wishes = transaction.objectStore("wish");
    for (const key of await wishes.getAllKeys()) {
      // The tablet is paired with another session now, or this one is over.
      if (key !== state.session_id || state.screen === "finished") await wishes.delete(key);
    }
    const screens = transaction.objectStore("screen");
    if (state.screen === "finished") {
      await screens.delete(LAST);
      const drafts = transaction.objectStore("kept");
      for (const kept of await drafts.getAll()) {
        const over = kept.sessionId === state.session_id && kept.queued === null;
        if (over) await drafts.delete(kept.id);
      }
    } else await screens.put(state, LAST);
    await transaction.done;
  }

  /** What was shown last, for a start without a network. */
  async lastScreen(): Promise<TabletState | undefined> {
    return (await this.#database).get("screen", LAST);
  }

  /** The tablet has lost its session: what that showed is nobody's business any more. */
  async forgetScreen(): Promise<void> {
    const transaction = (await this.#database).transaction(["screen", "signing"], "readwrite");
    await transaction.objectStore("screen").delete(LAST);
    await transaction.objectStore("signing").clear();
    await transaction.done;
  }

  /** Keep how far the consent on this screen has come. */
  async keepSigning(state: TabletState, signing: Signing): Promise<void> {
    await (await this.#database).put("signing", signing, signingKey(state));
  }

  /** How far it had come, before a reload or the browser's end. */
  async signing(state: TabletState): Promise<Signing | undefined> {
    return (await this.#database).get("signing", signingKey(state));
  }

  /** Keep what the participant says about taking part, until the server knows of it. */
  async keepWish(sessionId: string, wish: RefusalWish): Promise<void> {
    const options = { durability: "strict" } as const;
    const transaction = (await this.#database).transaction("wish", "readwrite", options);
    await transaction.store.put(wish, sessionId);
    await transaction.done;
  }

  /** What still waits to be sent, also after a reload or the browser's end. */
  async wish(sessionId: string): Promise<RefusalWish | undefined> {
    return (await this.#database).get("wish", sessionId);
  }

  /** The server knows of it; a newer wish stays. */
  async forgetWish(sessionId: string, wishId: string): Promise<void> {
    const transaction = (await this.#database).transaction("wish", "readwrite");
    const known = await transaction.store.get(sessionId);
    if (known?.wish_id === wishId) await transaction.store.delete(sessionId);
    await transaction.done;
  }

  /** Drafts that nobody went on with for two days leave the tablet; what waits to be sent stays. */
  async forgetOld(now: Date): Promise<void> {
    const transaction = (await this.#database).transaction("kept", "readwrite");
    for (const kept of await transaction.store.getAll()) {
      const age = now.getTime() - Date.parse(kept.startedAt);
      if (kept.queued === null && age > OLD_MS) await transaction.store.delete(kept.id);
    }
    await transaction.done;
  }

  async close(): Promise<void> {
    (await this.#database).close();
  }
}

/** The screen when its form was sent and nobody could say yet what comes. */
const waitingAfter = (state: TabletState): TabletState => ({
  ...state,
  screen: "waiting",
  administration: null,
  title: null,
  text: null,
  next: null,
});
