/** The panel of a calibration that is under way: drawn anew when what it says has changed. */
import type { CalibrationPrompt } from "../../calibration";
import {
  calibrationScreen,
  type PanelContent,
  type PanelScreen,
  type PanelWords,
} from "../../panels";

export class CalibrationPanel implements PanelContent {
  onChange: (() => void) | null = null;
  readonly #onPress: (target: string) => void;
  #screen: PanelScreen;
  #said: string;

  constructor(words: PanelWords, prompt: CalibrationPrompt, onPress: (target: string) => void) {
    this.#onPress = onPress;
    this.#screen = calibrationScreen(words, prompt);
    this.#said = said(this.#screen);
  }

  get screen(): PanelScreen {
    return this.#screen;
  }

  follow(words: PanelWords, prompt: CalibrationPrompt): void {
    const screen = calibrationScreen(words, prompt);
    const now = said(screen);
    if (now === this.#said) return;
    this.#said = now;
    this.#screen = screen;
    this.onChange?.();
  }

  press(target: string): void {
    this.#onPress(target);
  }
}

const said = (screen: PanelScreen): string => JSON.stringify(screen);
