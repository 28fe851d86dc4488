import type { CSSProperties, JSX } from "react";
import classes from "./Legend.module.css";

interface LegendProps {
  readonly entries: readonly { readonly name: string; readonly colour: string }[];
}

/** A list of what the colours of a stage mean, drawn in its corner. */
export function Legend({ entries }: LegendProps): JSX.Element {
  return (
    <ul className={classes.legend}>
      {entries.map(({ name, colour }) => (
        <li key={name} style={{ "--mark": colour } as CSSProperties}>
          {name}
        </li>
      ))}
    </ul>
  );
}
