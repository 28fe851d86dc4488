/** The answers on a page that is drawn without React. */
import { choose, currentForm, keepEarlyForm, takesBack } from "./earlyForm";

/** Keep what is chosen; `onAnswer` is called after each answer. */
export function listenToChoices(
  root: HTMLElement,
  signal: AbortSignal,
  onAnswer: () => void,
): void {
  const put = (input: HTMLInputElement, written: string | null): void => {
    const early = currentForm();
    if (early === null) return;
    keepEarlyForm(choose(early, keyOf(input), written, new Date()));
    onAnswer();
  };
  // A radio button is clicked before it has changed: one that was chosen already does not change.
  const onClick = ({ target }: Event): void => {
    const early = currentForm();
    if (early === null || !(target instanceof HTMLInputElement)) return;
    if (!takesBack(early, keyOf(target), target.value)) return;
    target.checked = false;
    put(target, null);
  };
  const onChange = ({ target }: Event): void => {
    if (target instanceof HTMLInputElement) put(target, target.value);
  };
  root.addEventListener("click", onClick, { signal });
  root.addEventListener("change", onChange, { signal });
}

const keyOf = (input: HTMLInputElement): string =>
  input.closest<HTMLElement>("[data-name]")?.dataset.name ?? "";

/** The selector of the answer that has the focus: it finds the same one after it is drawn anew. */
export function focusedAnswer(root: HTMLElement): string | null {
  const input = document.activeElement;
  if (!(input instanceof HTMLInputElement) || !root.contains(input)) return null;
  return `[data-name="${CSS.escape(keyOf(input))}"] [value="${CSS.escape(input.value)}"]`;
}
