/** One result: a sentence, its numbers, its method, and the line for a paper. */
import { Badge, Button, Title } from "@mantine/core";
import type { Result } from "@shared/api/analysis";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { type JSX, useState } from "react";
import { useTexts } from "../../i18n";
import { NumbersTable } from "../../ui/tables";
import classes from "./StatisticsTab.module.css";

export function ResultCard({ result }: { readonly result: Result }): JSX.Element {
  const { t } = useTexts();
  return (
    <article className={classes.result}>
      <div className={classes.head}>
        <Title order={4} size="h5">
          {result.title}
        </Title>
        {result.exploratory && (
          <Badge variant="outline" color="gray" size="sm">
            {t("statistics.exploratory")}
          </Badge>
        )}
        {result.apa !== "" && <CopyButton text={result.apa} />}
      </div>
      <p className={classes.sentence}>{result.sentence}</p>
      {result.warnings.map((warning) => (
        <div key={warning} className={classes.warning}>
          <Notice tone="warn">{warning}</Notice>
        </div>
      ))}
      {result.rows.length > 0 && (
        <NumbersTable label={result.title} columns={result.columns} rows={result.rows} />
      )}
      {result.method !== "" && (
        <details className={classes.method}>
          <summary>{t("statistics.method")}</summary>
          <p>
            {result.method} <cite>{result.source}</cite>
          </p>
        </details>
      )}
    </article>
  );
}

interface CopyButtonProps {
  readonly text: string;
  readonly label?: string;
}

export function CopyButton({ text, label }: CopyButtonProps): JSX.Element {
  const { t } = useTexts();
  const [copied, setCopied] = useState(false);
  const copy = async (): Promise<void> => {
    await copyText(text);
    setCopied(true);
    setTimeout(() => setCopied(false), 2000);
  };
  return (
    <Button
      size="compact-xs"
      variant="subtle"
      className={classes.copy ?? ""}
      leftSection={<Icon name={copied ? "check" : "document"} size={14} />}
      onClick={() => void copy()}
    >
      <span aria-live="polite">
        {copied ? t("statistics.copied") : (label ?? t("statistics.copy"))}
      </span>
    </Button>
  );
}

/**
 * Copy a text. Pages without https have no clipboard API, so there it is copied from a selection.
 */
async function copyText(text: string): Promise<void> {
  if (navigator.clipboard !== undefined) return navigator.clipboard.writeText(text);
  const field = document.createElement("textarea");
  field.value = text;
  document.body.append(field);
  field.select();
  document.execCommand("copy");
  field.remove();
}
