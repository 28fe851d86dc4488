/**
 * What the panels of a visit show, made from what is wanted: screens in the participant's language,
 * the study's texts page by page, the form that is due.
 */
import type { StoredForms } from "@shared/forms/storedForms";
import {
  boundaryScreen,
  finishedScreen,
  type Measure,
  offlineScreen,
  type PanelContent,
  type PanelScreen,
  type PanelWords,
  pagesOfText,
  panelWords,
  pauseScreen,
  prompt,
  Reading,
  StillContent,
  standbyScreen,
  takeOffScreen,
} from "../../panels";
import type { TelemetryClient } from "../../telemetry";
import type { Desk } from "./desk";
import { DueForm } from "./dueForm";
import type { Wanted } from "./wanted";

type Size = readonly [widthM: number, depthM: number];

export interface ContentsParts {
  readonly telemetry: Pick<TelemetryClient, "welcome">;
  readonly desk: Desk;
  readonly store: StoredForms;
  readonly measure: Measure;
  readonly onCall: (what: "help") => void;
  readonly isWorn: () => boolean;
  /** The guarded space and the one that is needed. */
  readonly sizesOfSpace: () => { readonly haveM: Size; readonly needM: Size };
  /** The participant goes on in a space that is too small. */
  readonly onSpaceAccepted: () => void;
}

/** The current step's own words, and what is in the participant's hands. */
export interface StepTexts {
  readonly title: string | null;
  readonly text: string | null;
  /** The study's words for what happens during a phase. */
  readonly screenTexts: Readonly<Record<string, string>>;
  readonly holdsController: boolean;
}

export class Contents {
  readonly #parts: ContentsParts;
  #language = "";
  #words: PanelWords = panelWords("en");
  #form: DueForm | null = null;
  #read = -1;

  constructor(parts: ContentsParts) {
    this.#parts = parts;
  }

  get words(): PanelWords {
    return this.#words;
  }

  /** The step whose text was read; -1: none. */
  get read(): number {
    return this.#read;
  }

  /** Speak another language from now on; a form is opened anew, with its draft. */
  speak(language: string): void {
    this.#language = language;
    this.#words = panelWords(language);
    this.keepForm(null);
  }

  /** Close the form, unless it is the one with this key, which is still due. */
  keepForm(key: string | null): void {
    if (this.#form === null || this.#form.key === key) return;
    this.#form.dispose();
    this.#form = null;
  }

  /** The form was covered by something else, and is shown again. */
  formShownAgain(nowMs: number): void {
    this.#form?.shownAgain(nowMs);
  }

  dispose(): void {
    this.keepForm(null);
  }

  /** The content of what is wanted; null: nothing. */
  of(next: Wanted, step: StepTexts): PanelContent | null {
    const words = this.#words;
    const still = (screen: PanelScreen) => new StillContent(screen);
    const title = step.title ?? words("waiting.title");
    switch (next.kind) {
      case "nothing":
        return null;
      case "edge":
        return still(boundaryScreen(words, { kind: "near" }));
      case "boundary":
        return this.#boundaryContent(next.problem);
      case "pause":
        return still(pauseScreen(words, next.pause));
      case "offline":
        return still(offlineScreen(words));
      case "finished":
        return still(finishedScreen(words));
      case "standby":
        return still(standbyScreen(words, step.holdsController));
      case "aloud":
        return still(
          prompt("aloud", words("aloud.title"), [step.title ?? "", words("aloud.body")]),
        );
      case "look_around":
        return still(prompt("look around", words("lookAround.title"), [words("lookAround.body")]));
      case "feet":
        return still(prompt("feet", title, [], words("feet.body")));
      case "take_off":
        return this.#parts.isWorn()
          ? still(takeOffScreen(words, next.isForm))
          : still(
              prompt("elsewhere", words("elsewhere.title"), [
                words(next.isForm ? "elsewhere.form" : "elsewhere.body"),
              ]),
            );
      case "stepping_in": {
        const how = words(step.holdsController ? "steppingIn.body" : "steppingIn.bodyHands");
        // The study's own text speaks of grips, which a keyboard does not have.
        const keys = this.#parts.isWorn() ? "" : words("steppingIn.keys");
        return still({
          ...prompt("stepping in", step.title ?? words("steppingIn.title"), [
            step.text ?? how,
            keys,
          ]),
          isLow: true,
        });
      }
      case "form":
        return this.#formContent(next.form);
      case "reading":
        return this.#reading(next.stepIndex, title, next.text);
      case "ready":
        return step.text === null
          ? still({ ...prompt("ready", title, [words("ready.body")]), isBeside: true })
          : this.#text(title, step.text, true);
      case "to_start":
        return still({
          ...prompt("to start", title, [words("toStart.body"), this.#keysToStart()]),
          isBeside: true,
        });
      case "preparing":
        return still(this.#countdown(title, step.text, next.secondsLeft));
      case "screen_text": {
        const { texts } = this.#parts.telemetry.welcome;
        const said = step.screenTexts[next.text] ?? texts[next.text];
        const keys = next.text === "walk_back" ? this.#keysToStart() : "";
        return typeof said === "string" && said !== ""
          ? still(prompt(next.text, undefined, [said, keys]))
          : null;
      }
      case "waiting":
        return this.#text(title, step.text ?? words("waiting.body"));
    }
  }

  /** A text of the study that only waits to be read; beside what it may tell to look at. */
  #text(title: string, text: string, isBeside = false): PanelContent {
    const { measure } = this.#parts;
    return new Reading({ title, text, words: this.#words, measure, onRead: null, isBeside });
  }

  #reading(stepIndex: number, title: string, text: string): PanelContent {
    const words = this.#words;
    if (this.#read === stepIndex) {
      return new StillContent(prompt("read", title, [words("sent.body")]));
    }
    const { measure } = this.#parts;
    return new Reading({
      title,
      text,
      words,
      measure,
      onRead: () => this.#acknowledge(stepIndex),
      onAsk: () => this.#parts.onCall("help"),
    });
  }

  #acknowledge(stepIndex: number): void {
    this.#read = stepIndex;
    // The text can be read once more if the server was not told.
    this.#parts.desk.acknowledge(stepIndex).catch(() => {
      this.#read = -1;
    });
  }

  /** How somebody at a screen walks to the start square; empty for whoever walks themselves. */
  #keysToStart(): string {
    return this.#parts.isWorn() ? "" : this.#words("toStart.keys");
  }

  #countdown(title: string, text: string | null, secondsLeft: number | null): PanelScreen {
    const words = this.#words;
    const [first = []] = text === null ? [] : pagesOfText(text, () => true);
    const left =
      secondsLeft === null
        ? words("preparing.traffic")
        : words("preparing.countdown", { seconds: secondsLeft });
    return {
      key: "preparing",
      isBeside: true,
      lead: left,
      title,
      ...(first.length > 0 ? { body: first } : {}),
    };
  }

  #formContent(key: string): PanelContent {
    if (this.#form === null) {
      const { telemetry, desk, store, onCall } = this.#parts;
      this.#form = new DueForm({
        key,
        sessionId: telemetry.welcome.session_id,
        language: this.#language,
        words: this.#words,
        store,
        desk,
        onSpoken: () => onCall("help"),
      });
    }
    return this.#form;
  }

  #boundaryContent(problem: "missing" | "too_small"): PanelContent {
    const words = this.#words;
    const { haveM, needM } = this.#parts.sizesOfSpace();
    const screen = boundaryScreen(
      words,
      problem === "missing" ? { kind: "missing" } : { kind: "small", haveM, needM },
    );
    const goOn = { target: "go on", text: words("boundary.goOn"), side: "right" } as const;
    return new StillContent({ ...screen, buttons: [goOn] }, this.#parts.onSpaceAccepted);
  }
}
