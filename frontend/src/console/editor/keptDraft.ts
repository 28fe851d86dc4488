/** Unsaved texts in this browser's storage, so that closing a page loses nothing. */

const PREFIX = "reembody.draft.";

/** The slots of a new study: its unsaved draft, and a text that another page gives it to begin. */
export const NEW_STUDY = "new";
export const GIVEN_START = "given";

export interface KeptText {
  readonly text: string;
  /** When it was last changed, ISO 8601; null if an earlier release stored it. */
  readonly changedAt: string | null;
}

/** What is kept under an identifier; null if there is nothing. */
export function keptDraft(id: string): KeptText | null {
  const stored = localStorage.getItem(PREFIX + id);
  return stored === null ? null : read(stored);
}

export const storedDraft = (id: string): string | null => keptDraft(id)?.text ?? null;

/** Keep a text; one that is kept already stays with its time. */
export function storeDraft(id: string, text: string, now: Date = new Date()): void {
  if (storedDraft(id) === text) return;
  const kept: KeptText = { text, changedAt: now.toISOString() };
  try {
    localStorage.setItem(PREFIX + id, JSON.stringify(kept));
  } catch {
    // A full or forbidden storage must not prevent editing; the page still warns before it closes.
  }
}

export function dropDraft(id: string): void {
  localStorage.removeItem(PREFIX + id);
}

/** Earlier releases stored the bare text. */
function read(stored: string): KeptText {
  try {
    const kept = JSON.parse(stored) as Partial<Record<keyof KeptText, unknown>> | null;
    const at = kept?.changedAt;
    if (typeof kept?.text === "string") {
      const isTime = typeof at === "string" && !Number.isNaN(Date.parse(at));
      return { text: kept.text, changedAt: isTime ? at : null };
    }
  } catch {
    // Not JSON: a bare text.
  }
  return { text: stored, changedAt: null };
}
