/** An order of conditions as the latencies in milliseconds, darker for longer ones. */
import type { CSSProperties, JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./ui.module.css";

export function Order({ sequence }: { readonly sequence: readonly number[] }): JSX.Element {
  const { t } = useTexts();
  const ranks = [...new Set(sequence)].sort((a, b) => a - b);
  return (
    <span className={`${classes.order} numbers`}>
      <span className="visually-hidden">{t("order.label")}</span>
      {sequence.map((latency) => (
        <span
          key={latency}
          className={classes.latency}
          style={{ "--rank": ranks.indexOf(latency) } as CSSProperties}
        >
          {latency}
        </span>
      ))}
      <span className={classes.unit}>ms</span>
    </span>
  );
}
