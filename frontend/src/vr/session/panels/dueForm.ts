/** The form that is due: fetched, opened with what is kept of it on this device, and shown. */
import type { StoredForms } from "@shared/forms/storedForms";
import {
  hasSpoken,
  type PanelContent,
  type PanelScreen,
  type PanelWords,
  prompt,
  Questionnaire,
} from "../../panels";
import type { Desk } from "./desk";

export interface DueFormOptions {
  /** The key of the administration. */
  readonly key: string;
  readonly sessionId: string;
  readonly language: string;
  readonly words: PanelWords;
  readonly store: StoredForms;
  readonly desk: Desk;
  /** Stored, and the participant said some answers aloud. */
  readonly onSpoken: () => void;
}

const RETRY_MS = 2000;

export class DueForm implements PanelContent {
  onChange: (() => void) | null = null;
  readonly key: string;
  readonly #options: DueFormOptions;
  #questionnaire: Questionnaire | null = null;
  #isDisposed = false;

  constructor(options: DueFormOptions) {
    this.#options = options;
    this.key = options.key;
    void this.#load();
  }

  get screen(): PanelScreen {
    const { words } = this.#options;
    const loading = () => prompt(`${this.key} loading`, words("form.loading"), []);
    return this.#questionnaire?.screen ?? loading();
  }

  press(target: string, nowMs: number): void {
    this.#questionnaire?.press(target, nowMs);
  }

  /** It was covered by something else, which is no time that an answer took. */
  shownAgain(nowMs: number): void {
    this.#questionnaire?.shownAgain(nowMs);
  }

  dispose(): void {
    this.#isDisposed = true;
    this.onChange = null;
    this.#questionnaire?.dispose();
  }

  /** Fetch and open; without a connection, try again until the form is not due any more. */
  async #load(): Promise<void> {
    const { key, desk, sessionId, language, words, store, onSpoken } = this.#options;
    try {
      const administration = await desk.form();
      if (this.#isDisposed) return;
      // The state has moved on: the newest one says what is due.
      if (administration.key !== key) throw new Error(`${administration.key} is due, not ${key}`);
      const questionnaire: Questionnaire = await Questionnaire.open({
        sessionId,
        administration,
        language: administration.languages.includes(language) ? language : administration.language,
        words,
        store,
        // Here and not when it is settled: the state may show what comes next before the receipt.
        submit: async (submission) => {
          const receipt = await desk.submit(submission);
          if (hasSpoken(questionnaire.draft, submission)) onSpoken();
          return receipt;
        },
        onSettled: () => undefined,
        clock: { monotonicMs: () => performance.now(), now: () => new Date() },
        later: (run, ms) => setTimeout(run, ms),
      });
      if (this.#isDisposed) return questionnaire.dispose();
      questionnaire.onChange = () => this.onChange?.();
      this.#questionnaire = questionnaire;
      this.onChange?.();
    } catch {
      if (!this.#isDisposed) setTimeout(() => void this.#load(), RETRY_MS);
    }
  }
}
