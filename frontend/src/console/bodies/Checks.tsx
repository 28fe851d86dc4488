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
      {(check.lengths ?? []).length > 0 && <Lengths check={check} />}
      {(check.notes ?? []).map((note) => (
        <span key={note} className={classes.found}>
          {note}
        </span>
      ))}
    </>
  );
}

/** The lengths that a result comes from, each with what is usual in people of that stature. */
function Lengths({ check }: { readonly check: BodyCheck }): JSX.Element {
  const { t, language } = useTexts();
  const centimetres = (value: number) => decimals(100 * value, language, 1);
  return (
    <ul className={`${classes.lengths} numbers`}>
      {check.lengths.map(({ name, length_m, usual_m, low_m = null, high_m = null }) => {
        const hasRange = low_m !== null && high_m !== null;
        return (
          <li key={name}>
            <strong>{t(`bodies.length.${name}`)}</strong>{" "}
            {t(hasRange ? "bodies.length.range" : "bodies.length.usual", {
              length: centimetres(length_m),
              usual: centimetres(usual_m),
              low: centimetres(low_m ?? usual_m),
              high: centimetres(high_m ?? usual_m),
              stature: decimals(100 * (check.stature_m ?? 0), language, 0),
            })}
          </li>
        );
      })}
    </ul>
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
