/** What was checked about a body, each as a line that says what was found and what it means. */
import type { BodyCheck } from "@shared/api/bodies";
import { decimals, number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./Bodies.module.css";

const ICONS = { good: "check", note: "info", warn: "alert", unknown: "help" } as const;
/** More parts than these are listed on request. */
const FEW = 6;

export function Checks({ checks }: { readonly checks: readonly BodyCheck[] }): JSX.Element {
  const { t } = useTexts();
  return (
    <ul className={classes.checks} aria-label={t("bodies.checks")}>
      {checks.map((check) => (
        <li key={check.key} data-status={check.status}>
          <Icon name={ICONS[check.status]} size={18} />
          <div>
            <strong>{t(`bodies.check.${check.key}`)}</strong>
            <span className="visually-hidden">: {t(`bodies.status.${check.status}`)}</span>
            <Found check={check} />
          </div>
        </li>
      ))}
    </ul>
  );
}

function Found({ check }: { readonly check: BodyCheck }): JSX.Element {
  const { t, language } = useTexts();
  const { value = null, limit = null } = check;
  const shown = (one: number | null) => {
    if (one === null) return "–";
    if (check.key === "hulls") return decimals(1000 * one, language, 1);
    return check.key === "reach" ? decimals(100 * one, language, 0) : number(one, language);
  };
  return (
    <>
      <span className={`${classes.found} numbers`}>
        {t(`bodies.check.${check.key}.${check.status}` as "bodies.check.parts.good", {
          value: shown(value),
          limit: shown(limit),
        })}
      </span>
      {(check.parts ?? []).length > 0 && <Parts parts={check.parts ?? []} />}
      {(check.notes ?? []).map((note) => (
        <span key={note} className={classes.found}>
          {note}
        </span>
      ))}
    </>
  );
}

function Parts({ parts }: { readonly parts: readonly string[] }): JSX.Element {
  const { t } = useTexts();
  const list = (
    <ul className={classes.chips}>
      {parts.map((part) => (
        <li key={part}>{part}</li>
      ))}
    </ul>
  );
  if (parts.length <= FEW) return list;
  return (
    <details className={classes.more}>
      <summary>{t("bodies.parts", { count: parts.length })}</summary>
      {list}
    </details>
  );
}
