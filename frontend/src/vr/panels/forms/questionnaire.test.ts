import "fake-indexeddb/auto";
import { ApiError, Unreachable } from "@shared/api/request";
import type { Item, Receipt, Submission } from "@shared/api/types";
import { administration } from "@shared/forms/example";
import { openForms, StoredForms } from "@shared/forms/storedForms";
import { uuid } from "@shared/uuid";
import { beforeEach, describe, expect, it, vi } from "vitest";
import { fits, layOut } from "../surface/layout";
import { wideMeasure } from "../testing/pointing";
import { panelWords } from "../texts";
import { Questionnaire } from "./questionnaire";
import { hasSpoken } from "./questionScreens";

const RECEIPT: Receipt = { receipt_id: "r", stored_at: "2026-01-01T12:00:00Z", duplicate: false };

/** One headset: its storage, its clock, and what it has sent. */
class Headset {
  nowMs = 1000;
  readonly name = uuid();
  readonly sent: Submission[] = [];
  readonly later: (() => void)[] = [];
  settled = 0;
  answer: () => Receipt = () => RECEIPT;

  /** Open the page (again), as after a reload. */
  open(language = "en", asked = administration): Promise<Questionnaire> {
    return Questionnaire.open({
      sessionId: "session",
      administration: asked,
      language,
      words: panelWords(language),
      store: new StoredForms(openForms(this.name)),
      submit: async (submission) => {
        this.sent.push(submission);
        return this.answer();
      },
      onSettled: () => {
        this.settled += 1;
      },
      clock: { monotonicMs: () => this.nowMs, now: () => new Date(1.7e12 + this.nowMs) },
      later: (run) => this.later.push(run),
    });
  }

  press(form: Questionnaire, ...targets: readonly string[]): void {
    for (const target of targets) {
      const { buttons = [], choices } = form.screen;
      const shown = [...buttons, ...(choices?.items ?? [])].map((one) => one.target);
      if (!shown.includes(target)) throw new Error(`no ${target} among ${shown.join(", ")}`);
      this.nowMs += 1000;
      form.press(target, this.nowMs);
    }
  }
}

const ANSWERS = [
  ["answer yes"],
  ["answer 4"],
  ["key 3", "key 5"],
  ["key 7", "key 0", "key .", "key 5"],
  ["answer left"],
  ["answer spoken"],
  [],
] as const;
const FILL = ["start", ...ANSWERS.flatMap((targets) => [...targets, "next"])];
const STORED = {
  glasses: true,
  calm: 4,
  age: 35,
  weight: 70.5,
  hand: "left",
  job: null,
  problems: null,
};

let headset: Headset;
beforeEach(() => {
  headset = new Headset();
});

describe("a form in the headset", () => {
  it("asks one question after the other, lists the answers, and sends them as the tablet does", async () => {
    const form = await headset.open();
    headset.press(form, ...FILL, "more", "submit");
    await vi.waitFor(() => expect(headset.settled).toBe(1));
    expect(headset.sent).toHaveLength(1);
    expect(headset.sent[0]).toMatchObject({
      administration: administration.key,
      answers: STORED,
      shown_order: administration.item_order,
      seed: administration.seed,
      language: "en",
    });
    expect(hasSpoken(form.draft, headset.sent[0] as Submission)).toBe(true);
    expect(form.screen.title).toBe("Thank you, your answers are stored");
  });

  it("times every answer from when its question was shown, and counts changes", async () => {
    const form = await headset.open();
    headset.press(form, "start", "answer no", "answer yes", "next", "answer 4", "next");
    headset.press(form, "key 3", "key 5", "next", "back", "back", "answer 2");
    headset.press(form, "next", "next", "next", "answer left", "next", "answer spoken", "next");
    headset.press(form, "next", "more", "submit");
    await vi.waitFor(() => expect(headset.settled).toBe(1));
    expect(headset.sent[0]?.item_traces).toMatchObject({
      glasses: { response_s: 1, changes: 1 },
      calm: { response_s: 1, changes: 1 },
      age: { response_s: 2, changes: 0 },
      hand: { response_s: 1, changes: 0 },
    });
    expect(headset.sent[0]?.timings).toMatchObject({ glasses: 3, calm: 12 });
  });

  it("goes on where it was after a reload, with its answers and its key", async () => {
    const before = await headset.open();
    headset.press(before, "start", "answer yes", "next", "answer 4", "next", "key 3");
    before.dispose();
    await vi.waitFor(async () => {
      const form = await headset.open();
      expect(form.screen.progress?.text).toBe("Question 3 of 7");
      expect(form.screen.choices).toMatchObject({ layout: "keys", entry: "3 years" });
    });
    const form = await headset.open("de");
    expect(form.screen.progress?.text).toBe("Frage 3 von 7");
    headset.press(form, "key 5", "next", "next", "answer left", "next", "answer spoken", "next");
    headset.press(form, "next", "more", "submit");
    await vi.waitFor(() => expect(headset.settled).toBe(1));
    expect(headset.sent[0]?.answers).toEqual({ ...STORED, weight: null });
  });

  it("keeps somebody on a question that must be answered, and says why", async () => {
    const form = await headset.open();
    headset.press(form, "start", "next");
    expect(form.screen.problem).toBe("Please answer this question.");
    expect(form.screen.progress?.text).toBe("Question 1 of 7");
    headset.press(form, "answer yes");
    expect(form.screen.problem).toBeNull();
    headset.press(form, "next", "answer 4", "next", "key 7", "next");
    expect(form.screen.problem).toBe("At least 18 years");
    headset.press(form, "key delete", "key 4", "key 0", "next");
    expect(form.screen.progress?.text).toBe("Question 4 of 7");
  });

  it("lets an answer be changed from the list, and returns there", async () => {
    const form = await headset.open();
    headset.press(form, ...FILL, "review 1", "answer 2", "next");
    expect(form.screen.title).toBe("Your answers");
    const rows = form.screen.choices?.items ?? [];
    expect(rows[1]).toMatchObject({ text: "Calm".toLowerCase(), detail: "2 disagree" });
    headset.press(form, "more", "submit");
    await vi.waitFor(() => expect(headset.settled).toBe(1));
    expect(headset.sent[0]?.answers).toMatchObject({ calm: 2 });
    expect(headset.sent[0]?.item_traces?.calm?.changes).toBe(1);
  });

  it("keeps the answers while there is no connection, also through a reload, and sends them once", async () => {
    headset.answer = () => {
      throw new Unreachable("no answer");
    };
    const form = await headset.open();
    headset.press(form, ...FILL, "more", "submit");
    await vi.waitFor(() => expect(form.screen.title).toBe("Your answers are safe"));
    form.dispose();
    headset.answer = () => RECEIPT;
    const after = await headset.open();
    await vi.waitFor(() => expect(headset.settled).toBe(1));
    expect(after.screen.title).toBe("Thank you, your answers are stored");
    expect(new Set(headset.sent.map(({ idempotency_key }) => idempotency_key)).size).toBe(1);
  });

  it("returns refused answers for correction, and keeps those not wanted now", async () => {
    const form = await headset.open();
    headset.answer = () => {
      throw new ApiError(422, { code: "invalid_input", message: "1 answer is invalid" });
    };
    headset.press(form, ...FILL, "more", "submit");
    await vi.waitFor(() => expect(form.screen.problem).toBe("1 answer is invalid"));
    headset.answer = () => {
      throw new ApiError(409, { code: "not_now", message: "not due" });
    };
    headset.press(form, "check", "more", "submit");
    await vi.waitFor(() => expect(form.screen.title).toBe("These answers are not needed now"));
    headset.answer = () => RECEIPT;
    headset.press(form, "retry");
    await vi.waitFor(() => expect(headset.settled).toBe(1));
  });

  it("can answer whatever an instrument may ask", async () => {
    const many = Array.from({ length: 30 }, (_, at) => ({
      key: `c${at}`,
      label: { en: `A long name of the choice with the number ${at}` },
    }));
    const scale = { minimum: 0, maximum: 100, labels: [{ en: "not at all" }, { en: "fully" }] };
    const items: readonly Item[] = [
      { key: "many", text: { en: "Which? ".repeat(60) }, type: "choice", choices: many },
      { key: "fine", text: { en: "How much?" }, type: "likert", scale },
      { key: "cold", text: { en: "How cold?" }, type: "number", minimum: -50, maximum: 10 },
      { key: "big", text: { en: "How many?" }, type: "integer" },
    ];
    const asked = {
      ...administration,
      instrument: { ...administration.instrument, items },
      item_order: items.map(({ key }) => key),
    };
    const form = await headset.open("en", asked);
    const fill = ["start", "answer c29", "next", "answer 73", "next", "key minus", "key 2"];
    const rest = ["key .", "key 5", "next", ...[..."123456789"].map((sign) => `key ${sign}`)];
    for (const target of [...fill, ...rest, "next", "submit"]) {
      layOut(form.screen, wideMeasure);
      headset.press(form, target);
    }
    await vi.waitFor(() => expect(headset.settled).toBe(1));
    const answers = { many: "c29", fine: 73, cold: -2.5, big: 123456789 };
    expect(headset.sent[0]?.answers).toEqual(answers);
  });

  it("fits the panel on every screen, in both languages", async () => {
    for (const language of ["en", "de"]) {
      headset = new Headset();
      const form = await headset.open(language);
      for (const target of [...FILL, "more"]) {
        expect(fits(form.screen, wideMeasure)).toBe(true);
        headset.press(form, target);
      }
    }
  });
});
