/** Explains the marks around parts of a body; empty if there are none. */
import { type BodyMarks, MARK_COLOURS } from "@shared/stage/marks";
import type { CSSProperties, JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./MarksLegend.module.css";

export function MarksLegend({ marks }: { readonly marks: BodyMarks }): JSX.Element | null {
  const { t } = useTexts();
  const shown = (["cast", "passing"] as const).filter((kind) => marks[kind].length > 0);
  if (shown.length === 0) return null;
  return (
    <span className={classes.legend}>
      {shown.map((kind) => (
        <span key={kind} className={classes.entry}>
          <i
            className={kind === "cast" ? classes.sleeve : classes.net}
            style={{ "--mark": MARK_COLOURS[kind] } as CSSProperties}
          />
          {t(`avatarChanges.mark.${kind}`)}
        </span>
      ))}
    </span>
  );
}
