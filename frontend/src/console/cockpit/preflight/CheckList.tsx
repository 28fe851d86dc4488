/** The list of checks: what is in order, what is missing and what to do about it. */
import { Button } from "@mantine/core";
import type { Check } from "@shared/api/types";
import { timeOfDay } from "@shared/format";
import { CHECKS } from "@shared/session/registries.generated";
import { Icon, type IconName } from "@shared/ui/Icon";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { amountOf, expectationOf, hasTwoLines, todoOf, valuesOf } from "./checkTexts";
import classes from "./Preflight.module.css";

const ICONS: Readonly<Record<Check["status"], IconName>> = {
  ok: "check",
  unneeded: "minus",
  wait: "clock",
  fail: "alert",
  overridden: "flag",
};

interface CheckListProps {
  readonly checks: readonly Check[];
  /** Missing if no check can be overridden. */
  readonly onOverride?: ((check: Check) => void) | undefined;
}

export function CheckList({ checks, onOverride }: CheckListProps): JSX.Element {
  return (
    <ul className={classes.list}>
      {checks.map((check) => (
        <Row key={check.key} check={check} onOverride={onOverride} />
      ))}
    </ul>
  );
}

/** Every check while the list runs, so that nothing below moves once it says what it found. */
export function RunningChecks(): JSX.Element {
  const { t } = useTexts();
  return (
    <ul className={classes.list} aria-busy="true">
      {CHECKS.map((key) => (
        <li key={key} className={`${rowOf(key)} ${classes.wait}`}>
          <span className={classes.mark}>
            <Icon name="clock" size={18} />
          </span>
          <span className={classes.name}>{t(`preflight.check.${key}`)}</span>
          <span className={classes.found}>…</span>
        </li>
      ))}
    </ul>
  );
}

const rowOf = (key: Check["key"]): string =>
  hasTwoLines(key) ? `${classes.row} ${classes.twoLines}` : (classes.row ?? "");

interface RowProps {
  readonly check: Check;
  readonly onOverride: CheckListProps["onOverride"];
}

function Row({ check, onOverride }: RowProps): JSX.Element {
  const { t, language } = useTexts();
  const todo = todoOf(check);
  const override = check.status === "overridden" ? check.override : null;
  return (
    <li className={`${rowOf(check.key)} ${classes[check.status]}`} data-check={check.key}>
      <span className={classes.mark}>
        <Icon name={ICONS[check.status]} size={18} />
      </span>
      <span className={classes.name}>{t(`preflight.check.${check.key}`)}</span>
      <span className={`${classes.found} numbers`}>
        {t(`preflight.found.${check.code}`, valuesOf(check, language))}
        {!hasTwoLines(check.key) && <CheckDetails check={check} />}
      </span>
      <span className={classes.status}>{t(`preflight.status.${check.status}`)}</span>
      {hasTwoLines(check.key) && todo === null && (
        <div className={classes.todo}>
          <CheckDetails check={check} />
        </div>
      )}
      {todo !== null && (
        <div className={classes.todo}>
          <span>{t(todo)}</span>
          {onOverride !== undefined && (
            <Button
              size="compact-xs"
              variant="default"
              aria-label={`${t("preflight.override")}: ${t(`preflight.check.${check.key}`)}`}
              onClick={() => onOverride(check)}
            >
              {t("preflight.override")}
            </Button>
          )}
        </div>
      )}
      {override != null && (
        <div className={classes.todo}>
          {t("preflight.said", {
            by: override.by.replace(/^account:/, ""),
            time: timeOfDay(override.at, language),
            reason: override.reason,
          })}
        </div>
      )}
    </li>
  );
}

/** The limit of a check, and the names and hashes behind it. */
function CheckDetails({ check }: { readonly check: Check }): JSX.Element | null {
  const { t, language } = useTexts();
  const expectation = expectationOf(check);
  const parts = [...(check.details ?? [])];
  if (expectation !== null && check.limit != null) {
    parts.unshift(t(expectation, { limit: amountOf(check.limit, check.unit, language) }));
  }
  if (parts.length === 0) return null;
  const details = parts.join(" · ");
  return (
    <span className={classes.details} title={details}>
      {details}
    </span>
  );
}
