/**
 * What a participant has entered but the server has not confirmed, kept on the tablet (IndexedDB).
 *
 * A record goes through two states. A *draft* changes with every answer. *Queued*, its submission is
 * fixed, together with the idempotency key made when the form was first shown: however often it is
 * sent, after a lost answer or a reload, the server stores it once. The record is deleted when the
 * server has confirmed it, and not before.
 */
import type { Submission } from "@shared/api/types";
import type { FormDraft } from "@shared/forms/draft";
import { uuid } from "@shared/uuid";
import { type DBSchema, type IDBPDatabase, openDB } from "idb";

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
}

const OLD_MS = 48 * 3_600_000;

export const keptId = (sessionId: string, administration: string): string =>
  `${sessionId}/${administration}`;

export class DraftStore {
  readonly #database: Promise<IDBPDatabase<Tables>>;

  constructor(name = "reembody-tablet") {
    this.#database = openDB<Tables>(name, 1, {
      upgrade: (database) => void database.createObjectStore("kept", { keyPath: "id" }),
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
      draft: { data: {}, page: 0, timings: {} },
      queued: null,
    };
    if (known === undefined) await transaction.store.put(kept);
    await transaction.done;
    return kept;
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
    const transaction = (await this.#database).transaction("kept", "readwrite");
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

  /** The server has it: nothing of it stays on the tablet. */
  async forget(id: string): Promise<void> {
    await (await this.#database).delete("kept", id);
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
