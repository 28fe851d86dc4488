import "fake-indexeddb/auto";
import { ApiError, Unreachable } from "@shared/api/request";
import type { Receipt, Submission, TabletState } from "@shared/api/types";
import { deliver } from "@shared/forms/deliver";
import type { StoredForm } from "@shared/forms/storedForms";
import { uuid } from "@shared/uuid";
import { openDB } from "idb";
import { beforeEach, describe, expect, it } from "vitest";
import { isFinal } from "./refusal";
import { DraftStore } from "./store";

const NOW = new Date("2026-01-01T12:00:00Z");
const DRAFT = {
  data: { q1: 4 },
  page: 1,
  timings: { q1: 3.2 },
  traces: { q1: { response_s: 3.1, changes: 1 } },
};

const submissionOf = (form: StoredForm, answer = 4): Submission => ({
  idempotency_key: form.idempotencyKey,
  administration: form.administration,
  answers: { q1: answer },
  shown_order: ["q1"],
  seed: 1,
  language: "en",
  started_at_utc: form.startedAt,
  timings: {},
  item_traces: {},
});

let name: string;
let store: DraftStore;
let form: StoredForm;

beforeEach(async () => {
  name = uuid();
  store = new DraftStore(name);
  form = await store.open("session", "form#1", NOW);
});

describe("a draft", () => {
  it("is restored after a reload, with its original key", async () => {
    await store.keep(form.id, DRAFT);
    const reopened = await new DraftStore(name).open("session", "form#1", new Date());
    expect(reopened.draft).toEqual(DRAFT);
    expect(reopened.idempotencyKey).toBe(form.idempotencyKey);
    expect(reopened.startedAt).toBe(NOW.toISOString());
  });

  it("belongs to one session and one form only", async () => {
    await store.keep(form.id, DRAFT);
    expect((await store.open("other", "form#1", NOW)).draft.data).toEqual({});
    expect((await store.open("session", "form#2", NOW)).draft.data).toEqual({});
  });

  it("no longer changes once it is queued", async () => {
    await store.queue(form.id, submissionOf(form));
    await store.keep(form.id, { ...DRAFT, data: { q1: 7 } });
    expect((await store.open("session", "form#1", NOW)).draft.data).toEqual({});
  });

  it("is queued once: queuing a second submission returns the first", async () => {
    await store.queue(form.id, submissionOf(form, 4));
    const sent = await store.queue(form.id, submissionOf(form, 7));
    expect(sent.answers).toEqual({ q1: 4 });
  });

  it("is deleted from the tablet when it is old, unless it waits to be sent", async () => {
    const waiting = await store.open("session", "form#2", NOW);
    await store.queue(waiting.id, submissionOf(waiting));
    await store.keep(form.id, DRAFT);
    await store.forgetOld(new Date(NOW.getTime() + 49 * 3_600_000));
    expect((await store.open("session", "form#1", NOW)).draft.data).toEqual({});
    expect(await store.waiting("session")).toHaveLength(1);
  });
});

describe("delivering a form", () => {
  const receipt: Receipt = { receipt_id: "r", stored_at: NOW.toISOString(), duplicate: false };
  const refusal = (status: number, code: string) => new ApiError(status, { code, message: code });
  const failing = (error: Error) => async (): Promise<Receipt> => {
    throw error;
  };
  const attempt = async (submit: (submission: Submission) => Promise<Receipt>) => {
    const queued = await store.queue(form.id, submissionOf(form));
    return deliver(store, form.id, queued, submit);
  };

  it("deletes it when the server has stored it", async () => {
    expect(await attempt(async () => receipt)).toEqual({ kind: "stored" });
    expect(await store.waiting("session")).toEqual([]);
  });

  it("keeps it while there is no connection or the server is busy, and resends the same content", async () => {
    const keys: string[] = [];
    const offline = async (submission: Submission): Promise<Receipt> => {
      keys.push(submission.idempotency_key);
      throw new Unreachable("no answer");
    };
    expect(await attempt(offline)).toEqual({ kind: "later" });
    expect(await attempt(failing(refusal(503, "not_durable")))).toEqual({ kind: "later" });
    expect(await store.waiting("session")).toHaveLength(1);
    await attempt(offline);
    expect(new Set(keys)).toEqual(new Set([form.idempotencyKey]));
  });

  it("sends it once, however many callers ask while it is under way or after it has arrived", async () => {
    const keys: string[] = [];
    const counted = async (submission: Submission): Promise<Receipt> => {
      keys.push(submission.idempotency_key);
      return receipt;
    };
    const queued = await store.queue(form.id, submissionOf(form));
    const sendOnce = () => deliver(store, form.id, queued, counted);
    expect(await Promise.all([sendOnce(), sendOnce()])).toEqual([
      { kind: "stored" },
      { kind: "stored" },
    ]);
    expect(await sendOnce()).toEqual({ kind: "stored" });
    expect(keys).toEqual([form.idempotencyKey]);
  });

  it("keeps it if the tablet was disconnected or the form is not due", async () => {
    expect(await attempt(failing(refusal(401, "not_signed_in")))).toEqual({ kind: "unpaired" });
    expect((await attempt(failing(refusal(409, "not_now")))).kind).toBe("held");
    expect(await store.waiting("session")).toHaveLength(1);
  });

  it("returns it for correction if an answer is invalid", async () => {
    expect((await attempt(failing(refusal(422, "invalid_input")))).kind).toBe("refused");
    expect(await store.waiting("session")).toEqual([]);
    expect((await store.open("session", "form#1", NOW)).idempotencyKey).toBe(form.idempotencyKey);
  });

  it("deletes all forms of somebody who has withdrawn, and nobody else's", async () => {
    await store.open("session", "form#2", NOW);
    await store.open("other", "form#1", NOW);
    expect(await attempt(failing(refusal(410, "withdrawn")))).toEqual({ kind: "withdrawn" });
    expect(await store.waiting("session")).toEqual([]);
    expect((await store.open("session", "form#1", NOW)).idempotencyKey).not.toBe(
      form.idempotencyKey,
    );
  });

  it("deletes it if the experimenter has recorded the form already", async () => {
    expect(await attempt(failing(refusal(409, "conflict")))).toEqual({ kind: "superseded" });
    expect(await store.waiting("session")).toEqual([]);
  });
});

describe("the last screen", () => {
  const screen = (changed: Partial<TabletState> = {}): TabletState => ({
    session_id: "session",
    version: 4,
    language: "en",
    languages: ["en"],
    simulated: false,
    screen: "form",
    step_index: 2,
    title: "Embodiment",
    text: null,
    is_own_text: false,
    next: "The task",
    administration: { key: "form#1" } as TabletState["administration"],
    consent: null,
    help_asked: false,
    question_asked: false,
    is_refused: false,
    ...changed,
  });

  it("is restored after a restart, and only the newest one is kept", async () => {
    await store.keepScreen(screen());
    await store.keepScreen(screen({ version: 5 }));
    expect((await new DraftStore(name).lastScreen())?.version).toBe(5);
  });

  it("no longer shows a form once the server has its answers", async () => {
    await store.keepScreen(screen());
    await store.forget(form.id);
    const last = await store.lastScreen();
    expect([last?.screen, last?.administration, last?.next]).toEqual(["waiting", null, null]);
  });

  it("stays when another form is stored", async () => {
    await store.keepScreen(screen());
    await store.forget("session/form#0");
    expect((await store.lastScreen())?.screen).toBe("form");
  });

  it("is deleted with the session, as are drafts never submitted; submissions that wait to be sent stay", async () => {
    const waiting = await store.open("session", "form#2", NOW);
    await store.queue(waiting.id, submissionOf(waiting));
    await store.keep(form.id, DRAFT);
    await store.keepScreen(screen());
    await store.keepScreen(screen({ screen: "finished", administration: null }));
    expect(await store.lastScreen()).toBeUndefined();
    expect((await store.open("session", "form#1", NOW)).draft.data).toEqual({});
    expect(await store.waiting("session")).toHaveLength(1);
  });

  it("is deleted when the tablet is unpaired", async () => {
    await store.keepScreen(screen());
    await store.forgetScreen();
    expect(await store.lastScreen()).toBeUndefined();
  });
});

describe("an unfinished consent", () => {
  const wish = {
    session_id: "session",
    version: 2,
    screen: "consent",
    step_index: 0,
  } as TabletState;
  const SIGNING = { ticked: [0, 2], name: "", path: "M1 1L90 40", types: false };

  it("is restored after a restart, for its own step only", async () => {
    await store.keepScreen(wish);
    await store.keepSigning(wish, SIGNING);
    const reopened = new DraftStore(name);
    expect(await reopened.signing(wish)).toEqual(SIGNING);
    expect(await reopened.signing({ ...wish, step_index: 3 })).toBeUndefined();
    expect(await reopened.signing({ ...wish, session_id: "other" })).toBeUndefined();
  });

  it("stays while its screen is updated, and is deleted from the tablet once it was given", async () => {
    await store.keepSigning(wish, SIGNING);
    await store.keepScreen({ ...wish, version: 3, help_asked: true });
    expect(await store.signing(wish)).toEqual(SIGNING);
    await store.keepScreen({ ...wish, version: 4, screen: "form", step_index: 1 });
    expect(await store.signing(wish)).toBeUndefined();
  });

  it("is deleted when the tablet is unpaired or the session ends", async () => {
    await store.keepSigning(wish, SIGNING);
    await store.forgetScreen();
    expect(await store.signing(wish)).toBeUndefined();
    await store.keepSigning(wish, SIGNING);
    await store.keepScreen({ ...wish, screen: "finished" });
    expect(await store.signing(wish)).toBeUndefined();
  });
});

describe("a database written by an older version", () => {
  it("keeps its records: they are read, and missing fields are empty", async () => {
    const old = uuid();
    const database = await openDB(old, 1, {
      upgrade: (db) => void db.createObjectStore("kept", { keyPath: "id" }),
    });
    const { traces: _, ...draft } = DRAFT;
    await database.put("kept", { ...form, draft });
    database.close();
    const opened = await new DraftStore(old).open("session", "form#1", NOW);
    expect(opened.draft).toEqual({ ...DRAFT, traces: {} });
  });
});

describe("a refusal that waits to be sent", () => {
  const wish = (refused: boolean) => ({ wish_id: uuid(), step_index: 0, refused });

  it("is restored after a restart, only the newest of its session", async () => {
    const [first, second] = [wish(true), wish(false)];
    await store.keepWish("session", first);
    await store.keepWish("session", second);
    expect(await new DraftStore(name).wish("session")).toEqual(second);
    expect(await store.wish("other")).toBeUndefined();
  });

  it("is deleted by its own id, so that a late answer does not delete a newer one", async () => {
    const [first, second] = [wish(true), wish(false)];
    await store.keepWish("session", first);
    await store.keepWish("session", second);
    await store.forgetWish("session", first.wish_id);
    expect(await store.wish("session")).toEqual(second);
    await store.forgetWish("session", second.wish_id);
    expect(await store.wish("session")).toBeUndefined();
  });

  it("is resent until the server has decided on it", () => {
    const answered = (status: number) => new ApiError(status, { code: "x", message: "x" });
    expect([409, 422].map((status) => isFinal(answered(status)))).toEqual([true, true]);
    for (const status of [401, 429, 500, 503]) expect(isFinal(answered(status))).toBe(false);
    expect(isFinal(new Unreachable("no network"))).toBe(false);
  });
});
