/** What has been filled in so far: enough to go on after a reload, on the same page. */
export interface FormDraft {
  /** The answers as SurveyJS holds them, by item. */
  readonly data: Readonly<Record<string, unknown>>;
  readonly page: number;
  /** Seconds from the first showing of the form to the last change of each answer. */
  readonly timings: Readonly<Record<string, number>>;
}

export const EMPTY_DRAFT: FormDraft = { data: {}, page: 0, timings: {} };
