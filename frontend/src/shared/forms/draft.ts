import type { ItemTraces } from "./traces";

/** What has been filled in so far: enough to go on after a reload, on the same page. */
export interface FormDraft {
  /** What was chosen or typed, by item; nothing for what is not answered. */
  readonly data: Readonly<Record<string, unknown>>;
  readonly page: number;
  /** Seconds from the first showing of the form to the last change of each answer. */
  readonly timings: Readonly<Record<string, number>>;
  /** How long each answer took, and how often it was changed. */
  readonly traces: ItemTraces;
}

export const EMPTY_DRAFT: FormDraft = { data: {}, page: 0, timings: {}, traces: {} };
