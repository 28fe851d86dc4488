/** What is noticeable about how a form was filled in: quiet lines below its scores. */
import type { AdministrationScores } from "@shared/api/types";
import { number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import classes from "./AnswerHints.module.css";

type Hint = AdministrationScores["hints"][number];

export function AnswerHints({ hints }: { readonly hints: readonly Hint[] }): JSX.Element | null {
  const { t, language } = useTexts();
  if (hints.length === 0) return null;
  const words = ({ kind, items, value, seconds }: Hint) => {
    switch (kind) {
      case "alike":
        return t("hint.alike", { items, value: number(value ?? 0, language) });
      case "fast":
        return t("hint.fast", { items, seconds: number(seconds ?? 0, language) });
      case "left_out":
        return t("hint.left_out", { count: items });
    }
  };
  return (
    <ul className={classes.hints} title={t("hint.about")}>
      {hints.map((hint, place) => (
        // biome-ignore lint/suspicious/noArrayIndexKey: hints have no other name than their place
        <li key={place}>
          <Icon name="info" size={16} />
          <span>{words(hint)}</span>
        </li>
      ))}
    </ul>
  );
}
