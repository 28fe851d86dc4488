/** The preview of an import: counts, every invalid cell, and the first forms. */
import { Button, Title } from "@mantine/core";
import type { CellProblem, ImportCheck, ImportMapping } from "@shared/api/imports";
import { number } from "@shared/format";
import { Notice } from "@shared/ui/Notice";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./Imports.module.css";

interface CheckProps {
  readonly check: ImportCheck;
  readonly onShift: (part: Partial<ImportMapping>) => void;
}

export function CheckPanel({ check, onShift }: CheckProps): JSX.Element {
  const { t } = useTexts();
  const { shift } = check;
  return (
    <section className={classes.check} aria-label={t("imports.check")} aria-live="polite">
      <Title order={3} size="h5">
        {t("imports.check")}
      </Title>
      <p>
        {t("imports.counts", { forms: check.forms, people: check.participants })}{" "}
        {check.skipped_rows > 0 && t("imports.skipped", { count: check.skipped_rows })}{" "}
        {check.missing_answers > 0 && t("imports.missing", { count: check.missing_answers })}{" "}
        {check.conditions
          .map(({ condition, forms }) => `${condition || t("imports.noCondition")}: ${forms}`)
          .join(" · ")}
      </p>
      {shift !== null && (
        <Notice
          tone="info"
          title={t("imports.shift")}
          actions={
            <Button
              size="xs"
              variant="default"
              onClick={() => onShift({ multiply: shift.multiply, add: shift.add })}
            >
              {t("imports.shift.use", { formula: formula(shift.multiply, shift.add) })}
            </Button>
          }
        >
          {shift.why}
        </Notice>
      )}
      {check.notes.map((note) => (
        <Notice key={note} tone="warn">
          {note}
        </Notice>
      ))}
      {check.n_problems > 0 ? (
        <Problems problems={check.problems} count={check.n_problems} />
      ) : (
        <FirstForms check={check} />
      )}
    </section>
  );
}

interface ProblemsProps {
  readonly problems: readonly CellProblem[];
  readonly count: number;
}

function Problems({ problems, count }: ProblemsProps): JSX.Element {
  const { t } = useTexts();
  return (
    <>
      <Notice tone="bad" title={t("imports.problems", { count })}>
        {t("imports.problems.body")}
      </Notice>
      <section
        className={classes.problems}
        aria-label={t("imports.problems", { count })}
        // biome-ignore lint/a11y/noNoninteractiveTabindex: scrollable content must be reachable with the keyboard
        tabIndex={0}
      >
        <table className={`${classes.table} numbers`}>
          <thead>
            <tr>
              <th scope="col">{t("imports.line")}</th>
              <th scope="col">{t("imports.column")}</th>
              <th scope="col">{t("imports.value")}</th>
              <th scope="col">{t("imports.what")}</th>
            </tr>
          </thead>
          <tbody>
            {problems.map((one) => (
              <tr key={`${one.line} ${one.column} ${one.message}`}>
                <td>{one.line}</td>
                <td>{one.column}</td>
                <td>{one.value === "" ? "–" : `“${one.value}”`}</td>
                <td className={classes.words}>
                  {one.message} <span className={classes.soft}>{one.remedy}</span>
                </td>
              </tr>
            ))}
          </tbody>
        </table>
      </section>
    </>
  );
}

function FirstForms({ check }: { readonly check: ImportCheck }): JSX.Element | null {
  const { t, language } = useTexts();
  const [first] = check.first_forms;
  if (first === undefined) return null;
  const scores = Object.keys(first.scores);
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: scrollable content must be reachable with the keyboard
    <section className={classes.scroll} aria-label={t("imports.firstForms")} tabIndex={0}>
      <table className={`${classes.grid} numbers`}>
        <caption>{t("imports.firstForms")}</caption>
        <thead>
          <tr>
            <th scope="col">{t("imports.line")}</th>
            <th scope="col">{t("imports.participant")}</th>
            <th scope="col">{t("imports.condition")}</th>
            {scores.map((score) => (
              <th key={score} scope="col">
                {score}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {check.first_forms.map((form) => (
            <tr key={`${form.line} ${form.condition}`}>
              <td>{form.line}</td>
              <td>{form.participant_code}</td>
              <td>{form.condition || "–"}</td>
              {scores.map((score) => (
                <td key={score}>{formatted(form.scores[score], language)}</td>
              ))}
            </tr>
          ))}
        </tbody>
      </table>
    </section>
  );
}

/** A linear recoding as a formula: `5 × x − 5`. */
const formula = (multiply: number, add: number): string =>
  `${multiply} × x ${add < 0 ? "−" : "+"} ${Math.abs(add)}`;

const formatted = (value: number | null | undefined, language: string): string =>
  value === null || value === undefined ? "–" : number(value, language, 2);
