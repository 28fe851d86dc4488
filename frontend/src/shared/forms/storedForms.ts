/**
 * Forms kept on the device that they are filled in on (IndexedDB), even after its browser was
 * killed.
 *
 * A record has two states. A *draft* changes with every answer. Once *queued*, its submission is
 * fixed, together with the idempotency key made when the form was first shown: however often it is
 * sent, after a lost answer or a reload, the server stores it once. The record is deleted only when
 * the server has confirmed it.
 */
import { type DBSchema, type IDBPDatabase, openDB } from "idb";
import type { Administration, Answer, Submission } from "../api/types";
import { uuid } from "../uuid";
import { EMPTY_DRAFT, type FormDraft } from "./draft";

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

/** The part of a database that holds forms; its name is that of its first version. */
export interface FormTables extends DBSchema {
  kept: { key: string; value: StoredForm };
}

const OLD_MS = 48 * 3_600_000;

export const formId = (sessionId: string, administration: string): string =>
  `${sessionId}/${administration}`;

/** A form that nobody has answered yet, with a key of its own. */
export const newForm = (sessionId: string, administration: string, now: Date): StoredForm => ({
  id: formId(sessionId, administration),
  sessionId,
  administration,
  idempotencyKey: uuid(),
  startedAt: now.toISOString(),
  draft: EMPTY_DRAFT,
  queued: null,
});

/** The session of the form with this id. */
export const sessionOf = (id: string): string => id.slice(0, id.indexOf("/"));

/** Open a database that holds nothing but forms. */
export const openForms = (name: string): Promise<IDBPDatabase<FormTables>> =>
  openDB<FormTables>(name, 1, {
    upgrade: (database) => void database.createObjectStore("kept", { keyPath: "id" }),
    blocking: (_current, _wanted, event) => (event.target as IDBDatabase).close(),
  });

export class StoredForms {
  readonly #database: Promise<IDBPDatabase<FormTables>>;

  constructor(database: Promise<IDBPDatabase<FormTables>>) {
    this.#database = database;
  }

  /** The record of this form; a new one, with a key of its own, if there is none yet. */
  open(sessionId: string, administration: string, now: Date): Promise<StoredForm> {
    return this.openAs(newForm(sessionId, administration, now));
  }

  /** The record of this form; `fresh` itself if there is none yet. */
  async openAs(fresh: StoredForm): Promise<StoredForm> {
    const database = await this.#database;
    const transaction = database.transaction("kept", "readwrite");
    const existing = await transaction.store.get(fresh.id);
    if (existing === undefined) await transaction.store.put(fresh);
    await transaction.done;
    const stored = existing ?? fresh;
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
    if (known === undefined) throw new Error(`There is no draft ${id} on this device.`);
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

  /** Delete a form that the server has stored. */
  async forget(id: string): Promise<void> {
    await (await this.#database).delete("kept", id);
  }

  /** Delete all forms of a session: its participant has withdrawn, or was erased. */
  async forgetSession(sessionId: string): Promise<void> {
    const transaction = (await this.#database).transaction("kept", "readwrite");
    for (const form of await transaction.store.getAll()) {
      if (form.sessionId === sessionId) await transaction.store.delete(form.id);
    }
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

/** The submission of a form as it is now. */
export const submissionOf = (
  { idempotencyKey, startedAt, draft }: StoredForm,
  administration: Administration,
  language: string,
  answers: Readonly<Record<string, Answer>>,
): Submission => ({
  idempotency_key: idempotencyKey,
  administration: administration.key,
  answers,
  shown_order: administration.item_order,
  seed: administration.seed,
  language,
  started_at_utc: startedAt,
  timings: draft.timings,
  item_traces: draft.traces,
});
