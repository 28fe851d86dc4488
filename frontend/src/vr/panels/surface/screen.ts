/**
 * What one panel shows, as a value: words, answers to point at, buttons.
 *
 * Sizes everywhere in this folder are in *dmm*: millimetres per metre of distance, as seen by the
 * reader. A text of 24 dmm is 24 mm tall on a panel 1 m away and 42 mm at 1.75 m, so a layout holds
 * at any distance. 1 dmm is 0.057 degrees.
 */
import type { Paragraph } from "@shared/text";

/** One answer: `target` is what a press on it reports. */
export interface Choice {
  readonly target: string;
  readonly text: string;
  /** A number or sign before the text. */
  readonly badge?: string;
  readonly isChosen?: boolean;
  /** At most so many lines of the text, where it only has to be recognised. */
  readonly maxLines?: number;
  /** A second text at the end of the row, such as the answer given. */
  readonly detail?: string;
}

/**
 * Answers below each other (`rows`), side by side between two named ends (`steps`), or as keys for
 * digits (`keys`).
 */
export type Choices =
  | { readonly layout: "rows"; readonly items: readonly Choice[] }
  | {
      readonly layout: "steps";
      readonly items: readonly Choice[];
      readonly ends: readonly [string, string] | null;
    }
  | {
      readonly layout: "keys";
      readonly items: readonly Choice[];
      /** What has been entered so far, and what may be entered. */
      readonly entry: string;
      readonly hint: string;
    };

export interface PanelButton {
  readonly target: string;
  readonly text: string;
  readonly side: "left" | "right";
  readonly isPrimary?: boolean;
}

export interface PanelScreen {
  /** Names what is shown; a press right after it changed is not taken. */
  readonly key: string;
  /** Stands below the view straight ahead, so that the mirror stays to be seen. */
  readonly isLow?: boolean;
  /** Stands to the right of the view straight ahead, so that the whole mirror stays to be seen. */
  readonly isBeside?: boolean;
  /** A short line above the title: the stem of a questionnaire, the name of a step. */
  readonly lead?: string;
  readonly title?: string;
  /** Whether the title is a question to be read in full, in the size of text. */
  readonly isQuestion?: boolean;
  readonly body?: readonly Paragraph[];
  readonly choices?: Choices;
  /** Something to correct or to know, marked by a sign as well as a colour. */
  readonly problem?: string | null;
  readonly progress?: { readonly done: number; readonly of: number; readonly text: string };
  readonly buttons?: readonly PanelButton[];
}
