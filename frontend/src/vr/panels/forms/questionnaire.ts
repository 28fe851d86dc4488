/**
 * A form filled in inside the headset: the engine of the tablet's forms, drawn on a panel.
 *
 * Drafts, response times, checks and delivery are those of `shared/forms`; only what is seen differs:
 * one question at a time, large rows, a keypad for numbers, and a list of all answers before they
 * are sent. Every change is kept on the device before anything else happens to it.
 */
import type { ApiError } from "@shared/api/request";
import type { Administration, Answer } from "@shared/api/types";
import { deliver, type Submit } from "@shared/forms/deliver";
import { type FormDraft, pageShown } from "@shared/forms/draft";
import {
  answer,
  type Filling,
  type Pages,
  pageOf,
  shownProblem,
  showPage,
  startFilling,
  stopAt,
  stopAtAny,
} from "@shared/forms/filling";
import { answersOf, type Question, questionPages } from "@shared/forms/questions";
import { type StoredForm, type StoredForms, submissionOf } from "@shared/forms/storedForms";
import { type FormTexts, formTexts } from "@shared/forms/texts";
import type { PanelContent } from "../content";
import type { PanelScreen } from "../surface/screen";
import type { PanelWords } from "../texts";
import {
  answerTarget,
  asAsked,
  introScreen,
  questionScreen,
  REVIEW_ROWS,
  reviewScreen,
  typed,
} from "./questionScreens";

export interface QuestionnaireOptions {
  readonly sessionId: string;
  readonly administration: Administration;
  /** The language shown, one of the administration's. */
  readonly language: string;
  readonly words: PanelWords;
  readonly store: StoredForms;
  readonly submit: Submit;
  /** The form is stored, superseded or no longer wanted: the state shows what comes next. */
  readonly onSettled: () => void;
  readonly clock: { readonly monotonicMs: () => number; readonly now: () => Date };
  /** Run later; a delivery without a connection is tried again. */
  readonly later: (run: () => void, ms: number) => void;
}

type Stage =
  | { readonly name: "intro" }
  | { readonly name: "question"; readonly isReviewed: boolean }
  | { readonly name: "review"; readonly page: number }
  | { readonly name: "refused"; readonly error: ApiError }
  | { readonly name: "sending"; readonly offline: boolean }
  | { readonly name: "held" }
  | { readonly name: "done" };

const RETRY_MS = 3000;

export class Questionnaire implements PanelContent {
  onChange: (() => void) | null = null;
  readonly #options: QuestionnaireOptions;
  readonly #texts: FormTexts;
  readonly #pages: Pages;
  #form: StoredForm;
  #filling: Filling;
  #stage: Stage;
  #disposed = false;

  /** Open the form with what is kept of it on this device; what waits to be sent is sent. */
  static async open(options: QuestionnaireOptions): Promise<Questionnaire> {
    const { store, sessionId, administration, clock } = options;
    const form = await store.open(sessionId, administration.key, clock.now());
    const questionnaire = new Questionnaire(options, form);
    if (form.queued !== null) void questionnaire.#deliver(form.queued);
    return questionnaire;
  }

  private constructor(options: QuestionnaireOptions, form: StoredForm) {
    const { administration, language, words, clock } = options;
    this.#options = options;
    this.#form = form;
    this.#texts = formTexts(words);
    const asked = { language, words: this.#texts, canOmit: false, isOnePerPage: true };
    this.#pages = questionPages(administration, asked).map((page) => page.map(asAsked(words)));
    this.#filling = startFilling(form.draft, clock.monotonicMs());
    const hasBegun = form.draft.page > 0 || Object.keys(form.draft.data).length > 0;
    if (form.queued !== null) this.#stage = { name: "sending", offline: false };
    else this.#stage = hasBegun ? { name: "question", isReviewed: false } : { name: "intro" };
  }

  get screen(): PanelScreen {
    const { administration, language, words } = this.#options;
    const shown = { administration, language, words };
    const stage = this.#stage;
    switch (stage.name) {
      case "intro":
        return introScreen(shown);
      case "question": {
        const question = this.#question;
        if (question === undefined) return this.#review(0);
        return questionScreen({
          ...shown,
          question,
          value: this.#filling.draft.data[question.key],
          problem: shownProblem(this.#filling, question, this.#texts),
          number: this.#page + 1,
          total: this.#pages.length,
          isReviewed: stage.isReviewed,
        });
      }
      case "review":
        return this.#review(stage.page);
      default:
        return this.#status(stage);
    }
  }

  get #page(): number {
    return pageOf(this.#filling, this.#pages);
  }

  get #question(): Question | undefined {
    return this.#pages[this.#page]?.[0];
  }

  #review(page: number): PanelScreen {
    const { administration, language, words } = this.#options;
    const questions = this.#pages.flat();
    const { data } = this.#filling.draft;
    return reviewScreen({ administration, language, words, questions, data, page });
  }

  #status(stage: Exclude<Stage, { name: "intro" | "question" | "review" }>): PanelScreen {
    const { words } = this.#options;
    const key = `${this.#options.administration.key} ${stage.name}`;
    const prose = (text: string) => [{ kind: "prose", text }] as const;
    switch (stage.name) {
      case "sending":
        return stage.offline
          ? { key, title: words("sending.offline"), body: prose(words("sending.offlineBody")) }
          : { key, title: words("sending.title"), body: prose(words("sending.body")) };
      case "held":
        return {
          key,
          title: words("held.title"),
          body: prose(words("held.body")),
          buttons: [{ target: "retry", text: words("sending.retry"), side: "right" }],
        };
      case "refused":
        return {
          key,
          title: words("refused.title"),
          body: prose(words("refused.body")),
          problem: stage.error.message,
          buttons: [
            { target: "check", text: words("form.review"), side: "right", isPrimary: true },
          ],
        };
      case "done":
        return { key, title: words("sent.title"), body: prose(words("sent.body")) };
    }
  }

  /** The question was covered by something else: its time begins again. */
  shownAgain(nowMs: number): void {
    this.#filling = { ...this.#filling, turn: pageShown(nowMs) };
  }

  press(target: string, nowMs: number): void {
    switch (this.#stage.name) {
      case "intro":
        if (target === "start") this.#ask(this.#page, nowMs, false);
        break;
      case "question":
        this.#pressOnQuestion(target, nowMs);
        break;
      case "review":
        this.#pressOnReview(target, nowMs, this.#stage.page);
        break;
      case "refused":
        if (target === "check") this.#stage = { name: "review", page: 0 };
        break;
      case "held":
        if (target === "retry") void this.#sendAgain();
        break;
    }
    this.onChange?.();
  }

  #pressOnQuestion(target: string, nowMs: number): void {
    const question = this.#question;
    if (question === undefined) return;
    const value = this.#filling.draft.data[question.key];
    if (target === "back") this.#ask(this.#page - 1, nowMs, false);
    else if (target === "next") this.#proceed(nowMs);
    else if (target.startsWith("key ")) {
      this.#answer(question, typed(value, target.slice(4)), nowMs);
    } else this.#choose(question, value, target, nowMs);
  }

  #choose(question: Question, value: unknown, target: string, nowMs: number): void {
    if (question.kind !== "rating" && question.kind !== "choice") return;
    const option = question.options.find((one) => answerTarget(one.value) === target);
    if (option === undefined) return;
    // Pressed again, an answer that is not required is taken back.
    const isTakenBack = option.value === value && !question.required;
    if (option.value === value && !isTakenBack) return;
    this.#answer(question, isTakenBack ? undefined : option.value, nowMs);
  }

  #answer(question: Question, value: string | number | undefined, nowMs: number): void {
    const startedMs = Date.parse(this.#form.startedAt);
    const sinceStartS = (this.#options.clock.now().getTime() - startedMs) / 1000;
    this.#keep(answer(this.#filling, question, value, { nowMs, sinceStartS }));
  }

  #proceed(nowMs: number): void {
    const stopped = stopAt(this.#filling, this.#pages, this.#page, this.#texts, nowMs);
    const isReviewed = this.#stage.name === "question" && this.#stage.isReviewed;
    const isLast = this.#page >= this.#pages.length - 1;
    if (stopped !== null) this.#keep(stopped);
    else if (!isReviewed && !isLast) this.#ask(this.#page + 1, nowMs, false);
    else {
      const page = isReviewed ? Math.floor(this.#page / REVIEW_ROWS) : 0;
      this.#stage = { name: "review", page };
    }
  }

  #ask(number: number, nowMs: number, isReviewed: boolean): void {
    this.#stage = { name: "question", isReviewed };
    const shown = showPage(this.#filling, this.#pages, Math.max(0, number), nowMs);
    // After the introduction or the list of answers the same question is shown anew.
    this.#keep({ ...shown, turn: pageShown(nowMs) });
  }

  #pressOnReview(target: string, nowMs: number, page: number): void {
    if (target === "more") this.#stage = { name: "review", page: page + 1 };
    else if (target === "back" && page > 0) this.#stage = { name: "review", page: page - 1 };
    else if (target === "back") this.#ask(this.#pages.length - 1, nowMs, false);
    else if (target === "submit") this.#submit(nowMs);
    else if (target.startsWith("review ")) this.#ask(Number(target.slice(7)), nowMs, true);
  }

  #keep(filling: Filling): void {
    const hasChanged = filling.draft !== this.#filling.draft;
    this.#filling = filling;
    if (!hasChanged) return;
    this.#form = { ...this.#form, draft: filling.draft };
    void this.#options.store.keep(this.#form.id, filling.draft);
  }

  #submit(nowMs: number): void {
    const stopped = stopAtAny(this.#filling, this.#pages, this.#texts, nowMs);
    if (stopped !== null) {
      this.#stage = { name: "question", isReviewed: true };
      this.#keep(stopped);
      return;
    }
    this.#stage = { name: "sending", offline: false };
    const { store, administration, language } = this.#options;
    const submission = submissionOf(this.#form, administration, language, this.#answers());
    void store.queue(this.#form.id, submission).then((queued) => this.#deliver(queued));
  }

  /** The answers as they are stored; what is said aloud is entered by the experimenter. */
  #answers(): Readonly<Record<string, Answer>> {
    const { instrument } = this.#options.administration;
    const answers = answersOf(instrument, this.#filling.draft.data);
    const isOpen = new Set(
      instrument.items.filter(({ type }) => type === "text").map(({ key }) => key),
    );
    return Object.fromEntries(
      Object.entries(answers).map(([key, value]) => [key, isOpen.has(key) ? null : value]),
    );
  }

  /** What has been filled in so far. */
  get draft(): FormDraft {
    return this.#filling.draft;
  }

  async #deliver(submission: Parameters<Submit>[0]): Promise<void> {
    const { store, submit, onSettled, later } = this.#options;
    const delivery = await deliver(store, this.#form.id, submission, submit);
    if (this.#disposed) return;
    switch (delivery.kind) {
      case "later":
        this.#become({ name: "sending", offline: true });
        later(() => {
          if (!this.#disposed) void this.#deliver(submission);
        }, RETRY_MS);
        return;
      case "held":
        return this.#become({ name: "held" });
      case "refused":
        return this.#become({ name: "refused", error: delivery.error });
      case "stored":
      case "superseded":
      case "withdrawn":
        this.#become({ name: "done" });
        return onSettled();
      case "unpaired":
        return onSettled();
    }
  }

  async #sendAgain(): Promise<void> {
    this.#become({ name: "sending", offline: false });
    const { store, sessionId, administration, clock } = this.#options;
    const { queued } = await store.open(sessionId, administration.key, clock.now());
    if (queued !== null) await this.#deliver(queued);
  }

  #become(stage: Stage): void {
    this.#stage = stage;
    this.onChange?.();
  }

  /** The form is no longer shown; what waits to be sent stays on the device. */
  dispose(): void {
    this.#disposed = true;
    this.onChange = null;
  }
}
