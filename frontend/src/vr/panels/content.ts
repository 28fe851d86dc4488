/**
 * What a panel shows over time: a screen that changes when something on it is pressed.
 *
 * Reading, forms and prompts are all such contents. They know nothing of three.js, rays or canvases,
 * and time is an argument.
 */
import type { PanelScreen } from "./surface/screen";

export interface PanelContent {
  readonly screen: PanelScreen;
  /** A target of the screen was pressed; milliseconds on the clock of `performance.now`. */
  press(target: string, nowMs: number): void;
  /** Called after the screen has changed by itself or by a press. */
  onChange: (() => void) | null;
}

/** A screen that stays as it is; its buttons are told to `onPress`. */
export class StillContent implements PanelContent {
  onChange: (() => void) | null = null;
  #screen: PanelScreen;
  readonly #onPress: (target: string) => void;

  constructor(screen: PanelScreen, onPress: (target: string) => void = () => {}) {
    this.#screen = screen;
    this.#onPress = onPress;
  }

  get screen(): PanelScreen {
    return this.#screen;
  }

  set screen(screen: PanelScreen) {
    this.#screen = screen;
    this.onChange?.();
  }

  press(target: string): void {
    this.#onPress(target);
  }
}
