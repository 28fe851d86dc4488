/**
 * The tablet's storage (IndexedDB) for working without a network, even after its browser was
 * killed: what a
 * participant has entered and the server has not confirmed, and the last screen.
 *
 * A record has two states. A *draft* changes with every answer. Once *queued*, its submission is
 * fixed, together with the idempotency key made when the form was first shown: however often it is
 * sent, after a lost answer or a reload, the server stores it once. The record is deleted only when
 * the server has confirmed it.
 *
 * A refusal to take part waits in the same way until the server has recorded it: the newest refusal
 * or
 * retraction of a session replaces the previous one.
 *
 * The screen is the newest one of the session that the tablet is paired with; it is deleted when
 * the
 * session or the pairing ends. An unfinished consent is kept with its ticked statements and its
 * signature for as long as it is on the screen, and is never sent automatically.
 */
import type { RefusalWish, Submission, TabletState } from "@shared/api/types";
import { EMPTY_DRAFT, type FormDraft } from "@shared/forms/draft";
import { uuid } from "@shared/uuid";
import { type DBSchema, type IDBPDatabase, openDB } from "idb";
import type { Signing } from "../screens/consentToSend";

export interface StoredForm {
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
  kept: { key: string; value: StoredForm };
  screen: { key: string; value: TabletState };
  signing: { key: string; value: Signing };
  wish: { key: string; value: RefusalWish };
}

/** The key of the only record in this store. */
const LAST = "last";

const OLD_MS = 48 * 3_600_000;

export const formId = (sessionId: string, administration: string): string =>
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
      // A page of a newer version is waiting to open the database.
      blocking: (_current, _wanted, event) => (event.target as IDBDatabase).close(),
    });
  }

  /** The record of this form; a new one, with a key of its own, if there is none yet. */
  async open(sessionId: string, administration: string, now: Date): Promise<StoredForm> {
    const id = formId(sessionId, administration);
    const database = await this.#database;
    const transaction = database.transaction("kept", "readwrite");
    const existing = await transaction.store.get(id);
    const stored = existing ?? {
      id,
      sessionId,
      administration,
      idempotencyKey: uuid(),
      startedAt: now.toISOString(),
      draft: EMPTY_DRAFT,
      queued: null,
    };
    if (existing === undefined) await transaction.store.put(stored);
    await transaction.done;
    // An older version may have stored it with fewer fields.
    return { ...stored, draft: { ...EMPTY_DRAFT, ...stored.draft } };
  }

  /** Store the newest answers; a form that is already queued or confirmed is left as it is. */
  async keep(id: string, draft: FormDraft): Promise<void> {
    const transaction = (await this.#database).transaction("kept", "readwrite");
    const known = await transaction.store.get(id);
    if (known !== undefined && known.queued === null) {
      await transaction.store.put({ ...known, draft });
    }
    await transaction.done;
  }

  /** Fix the submission to be sent. The first submission of a form is the only one. */
  async queue(id: string, submission: Submission): Promise<Submission> {
    // Strict: written to the disk, not only handed to the system, before the participant is told it
    // is safe.
    const options = { durability: "strict" } as const;
    const transaction = (await this.#database).transaction("kept", "readwrite", options);
    const known = await transaction.store.get(id);
    if (known === undefined) throw new Error(`There is no draft ${id} on this tablet.`);
    const queued = known.queued ?? submission;
    await transaction.store.put({ ...known, queued });
    await transaction.done;
    return queued;
  }

  /** Return a queued form to editing, after the server has rejected it and stored nothing. */
  async reopen(id: string): Promise<void> {
    const transaction = (await this.#database).transaction("kept", "readwrite");
    const known = await transaction.store.get(id);
    if (known !== undefined) await transaction.store.put({ ...known, queued: null });
    await transaction.done;
  }

  /** The forms of this session that wait to be sent. */
  async waiting(sessionId: string): Promise<readonly StoredForm[]> {
    const all = await (await this.#database).getAll("kept");
    return all.filter((stored) => stored.sessionId === sessionId && stored.queued !== null);
  }

  /** Delete a form that the server has stored; it is not shown again. */
  async forget(id: string): Promise<void> {
    const transaction = (await this.#database).transaction(["kept", "screen"], "readwrite");
    await transaction.objectStore("kept").delete(id);
    const screens = transaction.objectStore("screen");
    const last = await screens.get(LAST);
    if (last != null && id === formId(last.session_id, last.administration?.key ?? "")) {
      await screens.put(waitingAfter(last), LAST);
    }
    await transaction.done;
  }

  /** Store the screen that the server sent, or delete it if the session has ended. */
  async keepScreen(state: TabletState): Promise<void> {
    const tables = ["kept", "screen", "signing", "wish"] as const;
    const transaction = (await this.#database).transaction(tables, "readwrite");
    const signings = transaction.objectStore("signing");
    for (const key of await signings.getAllKeys()) {
      // Either the consent was given, or its screen is no longer shown.
      if (state.screen !== "consent" || key !== signingKey(state)) await signings.delete(key);
    }
    const wishes = transaction.objectStore("wish");
    for (const key of await wishes.getAllKeys()) {
      // The tablet is paired with another session now, or this one has ended.
      if (key !== state.session_id || state.screen === "finished") await wishes.delete(key);
    }
    const screens = transaction.objectStore("screen");
    if (state.screen === "finished") {
      await screens.delete(LAST);
      const drafts = transaction.objectStore("kept");
      for (const form of await drafts.getAll()) {
        const isOver = form.sessionId === state.session_id && form.queued === null;
        if (isOver) await drafts.delete(form.id);
      }
    } else await screens.put(state, LAST);
    await transaction.done;
  }

  /** The last screen, for a start without a network. */
  async lastScreen(): Promise<TabletState | undefined> {
    return (await this.#database).get("screen", LAST);
  }

  /** Delete the screen, and what belongs to its session, after the tablet was unpaired. */
  async forgetScreen(): Promise<void> {
    const transaction = (await this.#database).transaction(["screen", "signing"], "readwrite");
    await transaction.objectStore("screen").delete(LAST);
    await transaction.objectStore("signing").clear();
    await transaction.done;
  }

  /** Store the state of the unfinished consent on this screen. */
  async keepSigning(state: TabletState, signing: Signing): Promise<void> {
    await (await this.#database).put("signing", signing, signingKey(state));
  }

  /** The stored state of the unfinished consent, after a reload or a restart of the browser. */
  async signing(state: TabletState): Promise<Signing | undefined> {
    return (await this.#database).get("signing", signingKey(state));
  }

  /** Store a refusal or its retraction until the server has recorded it. */
  async keepWish(sessionId: string, wish: RefusalWish): Promise<void> {
    const options = { durability: "strict" } as const;
    const transaction = (await this.#database).transaction("wish", "readwrite", options);
    await transaction.store.put(wish, sessionId);
    await transaction.done;
  }

  /** The refusal or retraction that still waits to be sent, also after a restart of the browser. */
  async wish(sessionId: string): Promise<RefusalWish | undefined> {
    return (await this.#database).get("wish", sessionId);
  }

  /** Delete a refusal that the server has recorded; a newer one stays. */
  async forgetWish(sessionId: string, wishId: string): Promise<void> {
    const transaction = (await this.#database).transaction("wish", "readwrite");
    const known = await transaction.store.get(sessionId);
    if (known?.wish_id === wishId) await transaction.store.delete(sessionId);
    await transaction.done;
  }

  /** Delete drafts that have not changed for two days; submissions that wait to be sent stay. */
  async forgetOld(now: Date): Promise<void> {
    const transaction = (await this.#database).transaction("kept", "readwrite");
    for (const form of await transaction.store.getAll()) {
      const age = now.getTime() - Date.parse(form.startedAt);
      if (form.queued === null && age > OLD_MS) await transaction.store.delete(form.id);
    }
    await transaction.done;
  }

  async close(): Promise<void> {
    (await this.#database).close();
  }
}

/** The screen to show after its form was sent, until the server sends the next one. */
const waitingAfter = (state: TabletState): TabletState => ({
  ...state,
  screen: "waiting",
  administration: null,
  title: null,
  text: null,
  next: null,
});
