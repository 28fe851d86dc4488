/**
 * The tablet's storage (IndexedDB) for working without a network, even after its browser was
 * killed: what a
 * participant has entered and the server has not confirmed, and the last screen.
 *
 * Forms are kept as `StoredForms` says: as drafts, then queued until the server has confirmed them.
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
import type { FormDraft } from "@shared/forms/draft";
import { type FormTables, formId, StoredForms } from "@shared/forms/storedForms";
import { type IDBPDatabase, openDB } from "idb";
import type { Signing } from "../screens/consentToSend";

interface Tables extends FormTables {
  screen: { key: string; value: TabletState };
  signing: { key: string; value: Signing };
  wish: { key: string; value: RefusalWish };
}

/** The key of the only record in this store. */
const LAST = "last";
/** The key under which the id of the form is stored that was answered last. */
const ANSWERED = "reembody.tablet.answered";

const signingKey = ({ session_id, step_index }: TabletState): string =>
  `${session_id}/${step_index}`;

export class DraftStore extends StoredForms {
  readonly #database: Promise<IDBPDatabase<Tables>>;

  constructor(name = "reembody-tablet") {
    const database = openDB<Tables>(name, 4, {
      upgrade: (opened, before) => {
        if (before < 1) opened.createObjectStore("kept", { keyPath: "id" });
        if (before < 2) opened.createObjectStore("screen");
        if (before < 3) opened.createObjectStore("signing");
        if (before < 4) opened.createObjectStore("wish");
      },
      // A page of a newer version is waiting to open the database.
      blocking: (_current, _wanted, event) => (event.target as IDBDatabase).close(),
    });
    // The types of idb do not see that a database with more stores has those of a smaller one, too.
    super(database as unknown as Promise<IDBPDatabase<FormTables>>);
    this.#database = database;
  }

  /**
   * Whether there may be answers of this form, which is known before the database is open.
   *
   * It is wrong if another form was answered since, or this one by an older version of the page.
   */
  mayHaveAnswers(id: string): boolean {
    try {
      return localStorage.getItem(ANSWERED) === id;
    } catch {
      return true;
    }
  }

  override keep(id: string, draft: FormDraft): Promise<void> {
    this.#noteAnswered(id);
    return super.keep(id, draft);
  }

  override queue(id: string, submission: Submission): Promise<Submission> {
    this.#noteAnswered(id);
    return super.queue(id, submission);
  }

  #noteAnswered(id: string): void {
    try {
      localStorage.setItem(ANSWERED, id);
    } catch {
      // It is full. The note only saves the participant from seeing the form's first page for a
      // moment after a reload.
    }
  }

  /** Delete a form that the server has stored; it is not shown again. */
  override async forget(id: string): Promise<void> {
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
