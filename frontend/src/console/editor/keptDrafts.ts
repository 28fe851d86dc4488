/** What was written and not saved yet, kept in this browser: closing a page loses nothing. */
const PREFIX = "reembody.draft.";

export function keptDraft(id: string): string | null {
  return localStorage.getItem(PREFIX + id);
}

export function keepDraft(id: string, text: string): void {
  try {
    localStorage.setItem(PREFIX + id, text);
  } catch {
    // A full or forbidden storage must not stop the writing; the page still warns before it closes.
  }
}

export function dropDraft(id: string): void {
  localStorage.removeItem(PREFIX + id);
}
