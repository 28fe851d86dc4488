/** What a draft asks for, in a line: how large its design is and how long a visit. */
import type { components } from "@shared/api/schema";
import { number } from "@shared/format";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./Editor.module.css";

interface FiguresProps {
  readonly figures: components["schemas"]["StudyFigures"] | null;
}

export function Figures({ figures }: FiguresProps): JSX.Element | null {
  const { t, language } = useTexts();
  if (figures === null) return null;
  const { conditions, orders, slots, minutes } = figures;
  return (
    <dl className={`${classes.figures} numbers`}>
      {(
        [
          ["figures.conditions", conditions],
          ["figures.orders", orders],
          ["figures.slots", slots],
          ["figures.minutes", Math.round(minutes)],
        ] as const
      ).map(([key, value]) => (
        <div key={key}>
          <dd>
            {key === "figures.minutes" ? `≈ ${number(value, language)}` : number(value, language)}
          </dd>
          <dt>{t(key)}</dt>
        </div>
      ))}
    </dl>
  );
}
