/** What another operator changed between two views of a session, in the words of the console. */
import type { SessionView } from "@shared/api/types";
import type { Key } from "../../i18n";

export interface Change {
  readonly key: Key;
  readonly values?: Readonly<Record<string, string | number>>;
}

export function changesBetween(before: SessionView, after: SessionView): readonly Change[] {
  const changes: Change[] = [];
  if (before.status !== after.status) changes.push({ key: `change.status.${after.status}` });
  const step = after.current?.index;
  if (step !== undefined && step !== before.current?.index) {
    changes.push({ key: "change.step", values: { number: step + 1 } });
  } else if (after.current !== null && before.current?.status !== after.current.status) {
    changes.push({ key: `change.phase.${after.current.status}` });
  }
  const added = after.notes.length - before.notes.length;
  if (added > 0) changes.push({ key: "change.notes", values: { count: added } });
  return changes.length === 0 ? [{ key: "change.other" }] : changes;
}
