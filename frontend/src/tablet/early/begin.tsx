/**
 * Let the participant fill in a form before the application is there.
 *
 * The application needs a tenth of a second and more until it has drawn the form that the server
 * has written into the page. Until then the form's page is drawn from the same components without
 * React, and its answers are kept as the application keeps them: with their times, and in the
 * tablet's storage. The application continues with them.
 */
import type { Administration, TabletState } from "@shared/api/types";
import { pageOf, startFilling } from "@shared/forms/filling";
import { questionPages } from "@shared/forms/questions";
import { newForm, type StoredForm } from "@shared/forms/storedForms";
import { formTexts } from "@shared/forms/texts";
import { applyColorScheme } from "@shared/theme/colorScheme";
import { drafts } from "../drafts/drafts";
import { plainTexts } from "../i18n/plain";
import { languageOf, stateInPage } from "../stateInPage";
import { applySize, chosenSize } from "../textSize";
import { focusedAnswer, listenToChoices } from "./choices";
import { EarlyScreen } from "./EarlyScreen";
import {
  continued,
  currentForm,
  forgetEarlyForm,
  isUntouched,
  joined,
  keepEarlyForm,
} from "./earlyForm";
import { markup } from "./markup";
import { watchPresses } from "./presses";

interface Beginning {
  /** Fulfilled once the form is on the screen, at once if there is none to draw. */
  readonly shown: Promise<void>;
  /** Let the application take over; `draw` draws it in one go. */
  readonly takeOver: (draw: () => void) => Promise<void>;
}

const NOTHING: Beginning = { shown: Promise.resolve(), takeOver: async (draw) => draw() };

/** Draw the form of the screen in the page, if it is one that can be filled in without React. */
export function beginEarly(root: HTMLElement): Beginning {
  const state = stateInPage();
  if (state?.screen !== "form" || state.administration === null) return NOTHING;
  applySize(chosenSize());
  if (!hasBarOfOneLine(state)) return NOTHING;
  document.documentElement.lang = languageOf(state);
  applyColorScheme();
  const listening = new AbortController();
  const whenQuiet = watchPresses(listening.signal);
  const opening = openForm(root, state, state.administration, listening.signal).catch((error) => {
    // The application draws the form as if nothing had been here.
    forgetEarlyForm();
    reportError(error);
  });
  const takeOver = async (draw: () => void): Promise<void> => {
    await opening;
    await whenQuiet();
    listening.abort();
    const focused = focusedAnswer(root);
    draw();
    if (focused !== null) root.querySelector<HTMLElement>(focused)?.focus({ preventScroll: true });
  };
  return { shown: currentForm() === null ? Promise.resolve() : nextFrame(), takeOver };
}

/** The most that the mark, the gaps, the margins and a scroll bar take of the bar's width. */
const BESIDE_PX = 100;
/** The most that the bar's tools take, and what is said of a simulated session. */
const TOOLS_REM = 30;
const SIMULATED_REM = 10;

/**
 * Whether the bar has one line, whose height is reserved for what only the application can draw.
 *
 * On a phone or with large letters it has several, and the form would move down when they are drawn.
 */
function hasBarOfOneLine({ simulated, languages, help_asked }: TabletState): boolean {
  if (help_asked || languages.length > 2) return false;
  const rem = Number.parseFloat(getComputedStyle(document.documentElement).fontSize);
  const most = BESIDE_PX + rem * (TOOLS_REM + (simulated ? SIMULATED_REM : 0));
  return document.documentElement.clientWidth >= most;
}

/** No page that is hidden has frames. */
const LONGEST_FRAME_MS = 100;

const nextFrame = (): Promise<void> =>
  new Promise((resolve) => {
    requestAnimationFrame(() => setTimeout(resolve));
    setTimeout(resolve, LONGEST_FRAME_MS);
  });

/** Draw the form and keep its answers; fulfilled once it is known what is stored of it. */
async function openForm(
  root: HTMLElement,
  state: TabletState,
  administration: Administration,
  signal: AbortSignal,
): Promise<void> {
  const { session_id, language } = state;
  const t = plainTexts(languageOf(state));
  const texts = formTexts(t);
  const pages = questionPages(administration, { language, words: texts, canOmit: false });
  const draw = (form: StoredForm): void => {
    const filling = startFilling(form.draft, performance.now());
    const questions = pages[pageOf(filling, pages)] ?? [];
    // What is typed would be interrupted when the application takes over.
    if (!questions.every(({ kind }) => kind === "rating" || kind === "choice")) return;
    keepEarlyForm({ form, filling, questions });
    const simulated = t("bar.simulated");
    root.innerHTML = markup(
      <EarlyScreen {...{ state, administration, pages, filling, texts, simulated }} />,
    );
  };

  const fresh = newForm(session_id, administration.key, new Date());
  const opened = drafts.openAs(fresh);
  // Without answers in the storage nobody has to wait until it is open.
  if (!drafts.mayHaveAnswers(fresh.id)) draw(fresh);
  const keep = async (): Promise<void> => {
    await opened;
    const early = currentForm();
    if (early !== null) await drafts.keep(early.form.id, early.form.draft);
  };
  listenToChoices(root, signal, () => void keep());

  const stored = await opened;
  const early = currentForm();
  forgetEarlyForm();
  if (stored.queued !== null) root.replaceChildren();
  else if (early === null) draw(stored);
  else if (isUntouched(stored.draft)) keepEarlyForm(continued(early, stored));
  else {
    draw(joined(stored, early.form));
    await keep();
  }
}
