/**
 * An order of conditions as the latencies in milliseconds, darker for longer ones. Where conditions
 * share latencies, each is named by its body, too.
 */
import type { CSSProperties, JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./ui.module.css";

export interface OrderOfConditions {
  readonly sequence: readonly number[] | null;
  /** The body worn at each latency, null for the configuration's; null if latencies suffice. */
  readonly bodies?: readonly (string | null)[] | null;
}

/** The same text for the same order of conditions, and for no other. */
export const orderKey = ({ sequence, bodies }: OrderOfConditions): string =>
  JSON.stringify([sequence, bodies ?? null]);

interface OrderProps {
  readonly sequence: readonly number[];
  readonly bodies?: OrderOfConditions["bodies"] | undefined;
}

export function Order({ sequence, bodies = null }: OrderProps): JSX.Element {
  const { t } = useTexts();
  const ranks = [...new Set(sequence)].sort((a, b) => a - b);
  const named = bodies?.map((body) => body ?? t("order.configured"));
  return (
    <span className={`${classes.order} numbers`}>
      <span className="visually-hidden">{t(named ? "order.conditions" : "order.label")}</span>
      {sequence.map((latency, at) => (
        <span
          key={`${latency} ${named?.[at] ?? ""}`}
          className={classes.latency}
          style={{ "--rank": ranks.indexOf(latency) } as CSSProperties}
        >
          {named === undefined ? latency : `${named[at] ?? ""} ${latency} ms`}
        </span>
      ))}
      {named === undefined && <span className={classes.unit}>ms</span>}
    </span>
  );
}
