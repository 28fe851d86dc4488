/**
 * How many sessions an analysis is of, beside the choice of their kind.
 *
 * That newer data are on their way is a sign of its own size: words would move what is below them.
 */
import { Loader } from "@mantine/core";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./Counted.module.css";

interface CountedProps {
  /** Undefined until it has been loaded. */
  readonly found: { readonly n_completed: number; readonly n_not_valid: number } | undefined;
  /** How many sessions are still running, whose data so far are in it. */
  readonly running?: number;
  /** What is being done with newer data; null for nothing. */
  readonly doing: string | null;
}

export function Counted({ found, running = 0, doing }: CountedProps): JSX.Element {
  const { t } = useTexts();
  const more = found !== undefined && running > 0 ? t("dashboard.running", { count: running }) : "";
  const words = found === undefined ? "…" : `${sessionCounts(found, t)}${more}`;
  return (
    <span className={classes.counted}>
      <span className={classes.sign} title={doing ?? undefined}>
        {found !== undefined && doing !== null && (
          <Loader size={14} role="status" aria-label={doing} />
        )}
      </span>
      <span className={classes.words} title={words}>
        {words}
      </span>
    </span>
  );
}

/** How many sessions an analysis counts, and how many it excludes as not valid. */
export function sessionCounts(
  found: { readonly n_completed: number; readonly n_not_valid: number },
  t: ReturnType<typeof useTexts>["t"],
): string {
  const counted = t("dashboard.sessions", { count: found.n_completed - found.n_not_valid });
  return found.n_not_valid > 0
    ? `${counted} · ${t("validity.excluded", { count: found.n_not_valid })}`
    : counted;
}
