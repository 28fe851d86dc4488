/** Blocks in IndexedDB: one database per journal. Works in pages and in workers. */
import { type DBSchema, deleteDB, type IDBPDatabase, type IDBPTransaction, openDB } from "idb";
import type { Block, BlockStore, Change, Entry, Run, StoredJournal } from "./entries";

interface Tables extends DBSchema {
  about: { key: "sessionId"; value: string };
  runs: { key: number; value: Run };
  blocks: { key: number; value: Block };
  entries: { key: number; value: readonly Entry[] };
}

const ALL = ["about", "runs", "blocks", "entries"] as const;
const PREFIX = "reembody-telemetry/";

/**
 * How safely IndexedDB commits. "relaxed" hands the data to the operating system: they survive the
 * end of the page and of the browser; "strict" waits for the disk, so that they survive a power
 * loss too.
 */
export type Durability = "relaxed" | "strict";

export class IndexedDbBlocks implements BlockStore {
  readonly #storageKey: string;
  readonly #durability: Durability;
  #database: IDBPDatabase<Tables> | null = null;

  private constructor(storageKey: string, durability: Durability) {
    this.#storageKey = storageKey;
    this.#durability = durability;
  }

  static async open(storageKey: string, durability: Durability): Promise<IndexedDbBlocks> {
    const blocks = new IndexedDbBlocks(storageKey, durability);
    await blocks.#open();
    return blocks;
  }

  async load(): Promise<StoredJournal> {
    const database = this.#database ?? (await this.#open());
    const transaction = database.transaction(["about", "runs", "blocks"]);
    const [sessionId, runs, blocks] = await Promise.all([
      transaction.objectStore("about").get("sessionId"),
      transaction.objectStore("runs").getAll(),
      transaction.objectStore("blocks").getAll(),
    ]);
    return { sessionId: sessionId ?? null, runs, blocks };
  }

  /**
   * Every request is issued and committed without awaiting anything in between, so that a page's
   * last write needs no further turn of its event loop.
   */
  async write(change: Change): Promise<void> {
    const transaction = this.#writing(this.#database ?? (await this.#open()));
    try {
      issueRequests(transaction, change);
      transaction.commit();
      await transaction.done;
    } catch (error) {
      // A request that throws immediately does not end the transaction: abort it, or half of it
      // would stay.
      abort(transaction);
      throw error;
    }
  }

  async read(places: readonly number[]): Promise<readonly (readonly Entry[] | null)[]> {
    const database = this.#database ?? (await this.#open());
    const { store } = database.transaction("entries");
    const found = await Promise.all(places.map((place) => store.get(place)));
    return found.map((entries) => entries ?? null);
  }

  async clear(): Promise<void> {
    const transaction = this.#writing(this.#database ?? (await this.#open()));
    await Promise.all([
      transaction.done,
      ...ALL.map((name) => transaction.objectStore(name).clear()),
    ]);
  }

  close(): void {
    this.#database?.close();
  }

  async #open(): Promise<IDBPDatabase<Tables>> {
    const database = await openDB<Tables>(PREFIX + this.#storageKey, 1, {
      upgrade(fresh) {
        fresh.createObjectStore("about");
        fresh.createObjectStore("runs", { keyPath: "epoch" });
        fresh.createObjectStore("blocks", { keyPath: "place" });
        fresh.createObjectStore("entries");
      },
      // The browser may close the database on its own, for instance when its disk fails: the next
      // use opens it again.
      terminated: () => {
        this.#database = null;
      },
    });
    this.#database = database;
    return database;
  }

  #writing(database: IDBPDatabase<Tables>) {
    return database.transaction(ALL, "readwrite", { durability: this.#durability });
  }
}

type Writing = IDBPTransaction<Tables, typeof ALL, "readwrite">;

function issueRequests(transaction: Writing, change: Change): void {
  const [blocks, entries] = [transaction.objectStore("blocks"), transaction.objectStore("entries")];
  const deletedRange = IDBKeyRange.upperBound(change.forgetBelow, true);
  // A request that fails aborts the transaction, which reports the error.
  const quietly = (request: Promise<unknown>) => void request.catch(() => undefined);
  quietly(transaction.objectStore("about").put(change.sessionId, "sessionId"));
  quietly(blocks.delete(deletedRange));
  quietly(entries.delete(deletedRange));
  for (const run of change.runs) quietly(transaction.objectStore("runs").put(run));
  for (const { block, entries: held } of change.added) {
    quietly(blocks.put(block));
    quietly(entries.put(held, block.place));
  }
}

function abort(transaction: Writing): void {
  transaction.done.catch(() => undefined);
  try {
    transaction.abort();
  } catch {
    // The transaction has already ended.
  }
}

/** Delete a journal from this device; it must be closed. */
export const deleteJournal = (storageKey: string): Promise<void> => deleteDB(PREFIX + storageKey);

/** A journal that a session left on this device. */
export interface LeftJournal {
  readonly storageKey: string;
  readonly sessionId: string;
  readonly messages: number;
  readonly bytes: number;
}

/**
 * Journals with messages that no server has confirmed. Opening one and draining it delivers them.
 */
export async function leftJournals(): Promise<readonly LeftJournal[]> {
  const names = (await indexedDB.databases()).map(({ name }) => name ?? "");
  const found: LeftJournal[] = [];
  for (const name of names.filter((one) => one.startsWith(PREFIX))) {
    const storageKey = name.slice(PREFIX.length);
    const store = await IndexedDbBlocks.open(storageKey, "relaxed");
    const { sessionId, blocks } = await store.load();
    store.close();
    if (sessionId === null || blocks.length === 0) continue;
    const sum = (of: (block: Block) => number) => blocks.reduce((all, one) => all + of(one), 0);
    const [messages, bytes] = [sum((block) => block.messages), sum((block) => block.bytes)];
    found.push({ storageKey, sessionId, messages, bytes });
  }
  return found;
}
