/** Why a completed session does not count: one line for each shortfall. */
import type { Shortfall } from "@shared/api/types";
import { number } from "@shared/format";
import type { JSX } from "react";
import { type Key, useTexts } from "../i18n";
import classes from "./ui.module.css";

export function Shortfalls({ found }: { readonly found: readonly Shortfall[] }): JSX.Element {
  const words = useWords();
  return (
    <ul className={classes.shortfalls}>
      {found.map((one) => (
        <li key={`${one.step} ${one.code}`}>{words(one)}</li>
      ))}
    </ul>
  );
}

function useWords(): (one: Shortfall) => string {
  const { t, language } = useTexts();
  return ({ code, block, phase, instrument, value, limit }) => {
    const place = [
      block == null ? null : t("validity.block", { number: block }),
      phase == null ? null : t(`validity.phase.${phase}` as Key),
    ].filter((part) => part !== null);
    const what = t(`validity.${code}`, {
      instrument: instrument ?? "",
      value: number(value ?? 0, language, code === "phase_short" ? 1 : 0),
      limit: number(limit ?? 0, language, 1),
    });
    return place.length === 0 ? what : `${place.join(", ")}: ${what}`;
  };
}
