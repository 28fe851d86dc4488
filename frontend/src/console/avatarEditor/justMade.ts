/** The state of the address under which an avatar opens that was made a moment ago. */
export const JUST_MADE = { isNew: true } as const;

/** Whether the page was opened by making its avatar: the button that did it is gone. */
export const isJustMade = (): boolean =>
  (history.state as Partial<typeof JUST_MADE> | null)?.isNew === true;
