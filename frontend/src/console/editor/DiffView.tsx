/** Two versions of a study side by side: a summary, each change, and the text. */
import { type Difference, drafts, type StudyDiff } from "@shared/api/drafts";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { Loaded } from "../ui/Loaded";
import { ScrollBox } from "../ui/tables";
import classes from "./DiffView.module.css";
import type { Draft } from "./useDraft";

export function DiffView({ diff }: { readonly diff: StudyDiff }): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.diff}>
      {diff.same && diff.instruments.length === 0 ? (
        <Notice tone="info" title={t("diff.same")}>
          {t(diff.text === "" ? "diff.identical" : "diff.layout")}
        </Notice>
      ) : (
        <>
          <Notice
            tone={diff.new_ledger ? "warn" : "info"}
            icon={diff.new_ledger ? "alert" : "check"}
            title={t(diff.new_ledger ? "diff.newLedger" : "diff.sameLedger")}
          >
            {t(diff.new_ledger ? "diff.newLedger.body" : "diff.sameLedger.body")}{" "}
            {diff.under_way > 0 && t("diff.underWay", { count: diff.under_way })}
          </Notice>
          <Places changes={diff.changes} />
        </>
      )}
      {diff.instruments.length > 0 && (
        <p>
          {t("diff.instruments")} {diff.instruments.map(({ key }) => key).join(", ")}
        </p>
      )}
      {diff.text !== "" && (
        <details className={classes.details}>
          <summary>{t("diff.text")}</summary>
          <Unified text={diff.text} />
        </details>
      )}
    </div>
  );
}

function Places({ changes }: { readonly changes: readonly Difference[] }): JSX.Element {
  const { t } = useTexts();
  return (
    <ScrollBox label={t("diff.place")} className={classes.scroll}>
      <table className={classes.table}>
        <thead>
          <tr>
            <th scope="col">{t("diff.place")}</th>
            <th scope="col">{t("diff.before")}</th>
            <th scope="col">{t("diff.after")}</th>
          </tr>
        </thead>
        <tbody>
          {changes.map((change) => (
            <tr key={`${change.path} ${change.kind}`}>
              <th scope="row">
                <Icon name={ICONS[change.kind]} size={14} />
                <code>{change.path}</code>
                <span className={classes.kind}>{t(`diff.${change.kind}`)}</span>
              </th>
              <td>{change.kind === "added" ? "" : written(change.before)}</td>
              <td>{change.kind === "removed" ? "" : written(change.after)}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </ScrollBox>
  );
}

const ICONS = { added: "add", removed: "minus", changed: "redo" } as const;

const written = (value: unknown): string =>
  typeof value === "string" ? value : JSON.stringify(value, null, 1).replaceAll("\n", " ");

function Unified({ text }: { readonly text: string }): JSX.Element {
  const { t } = useTexts();
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: a scrollable region has to be focusable
    // biome-ignore lint/a11y/useSemanticElements: a section may not be preformatted
    <pre className={classes.unified} tabIndex={0} role="region" aria-label={t("diff.text")}>
      {text.split("\n").map((line, index) => (
        // biome-ignore lint/suspicious/noArrayIndexKey: lines of a text that never changes
        <code key={index} className={lineClass(line)}>
          {line === "" ? " " : line}
        </code>
      ))}
    </pre>
  );
}

function lineClass(line: string): string | undefined {
  if (line.startsWith("+++") || line.startsWith("---") || line.startsWith("@@"))
    return classes.where;
  if (line.startsWith("+")) return classes.plus;
  return line.startsWith("-") ? classes.minus : undefined;
}

interface ChangesProps {
  readonly draft: Draft;
  readonly studyKey: string;
  /** The text of the newest version: what is compared changes with it. */
  readonly stored: string;
}

/** What saving the draft would change, compared with the newest version. */
export function Changes({ draft, studyKey, stored }: ChangesProps): JSX.Element {
  const { t } = useTexts();
  const usable = draft.upToDate && draft.check?.ok === true;
  const query = useQuery({
    queryKey: ["draft-diff", studyKey, stored, draft.text],
    queryFn: () => drafts.diff(studyKey, draft.text),
    enabled: usable,
    gcTime: 0,
  });
  if (!usable && draft.problems.length > 0) {
    return (
      <Notice tone="warn" title={t("changes.broken")}>
        {t("dryRun.broken.body")}
      </Notice>
    );
  }
  return <Loaded query={query}>{(diff) => <DiffView diff={diff} />}</Loaded>;
}
