/** A short message on the page: what the problem is, and what to do about it. */
import { Button } from "@mantine/core";
import type { JSX, ReactNode } from "react";
import { ApiError, FileChanged, type Problem, Unreachable } from "../api/request";
import { Icon, type IconName } from "./Icon";
import classes from "./Notice.module.css";
import { isUnloaded } from "./unloaded";

export type Tone = "info" | "warn" | "bad" | "sim";

const ICONS: Readonly<Record<Tone, IconName>> = {
  info: "info",
  warn: "alert",
  bad: "alert",
  sim: "body",
};

interface NoticeProps {
  readonly tone: Tone;
  readonly title?: string;
  readonly children?: ReactNode;
  readonly remedy?: ReactNode;
  readonly actions?: ReactNode;
  readonly icon?: IconName;
  /** In one line, smaller, where it stands beside other things. */
  readonly compact?: boolean;
}

export function Notice({
  tone,
  title,
  children,
  remedy,
  actions,
  icon,
  compact = false,
}: NoticeProps): JSX.Element {
  return (
    <div
      className={`${classes.notice} ${classes[tone]}`}
      data-compact={compact || undefined}
      role={tone === "bad" ? "alert" : "status"}
    >
      <Icon name={icon ?? ICONS[tone]} />
      <div>
        {title !== undefined && <div className={classes.title}>{title}</div>}
        {children !== undefined && <div className={classes.body}>{children}</div>}
        {remedy !== undefined && <div className={classes.remedy}>{remedy}</div>}
        {actions !== undefined && <div className={classes.actions}>{actions}</div>}
      </div>
    </div>
  );
}

export interface ErrorTexts {
  readonly unreachable: string;
  readonly unreachableRemedy: string;
  readonly unexpected: string;
  readonly retry: string;
  readonly unloaded: string;
  /** Those of pages that take files. */
  readonly files?: FileTexts;
}

interface FileTexts {
  /** What is put before the number of a line. */
  readonly line: string;
  /** The message for a file that is not what it was when it was chosen. */
  readonly changed: (name: string) => string;
  readonly changedRemedy: string;
}

/** A page's own wording of errors, which it keeps under these keys. */
export const errorTexts = (
  t: (key: `error.${Exclude<keyof ErrorTexts, "unloaded" | "files">}` | "page.unknown") => string,
): ErrorTexts => ({
  unreachable: t("error.unreachable"),
  unreachableRemedy: t("error.unreachableRemedy"),
  unexpected: t("error.unexpected"),
  retry: t("error.retry"),
  unloaded: t("page.unknown"),
});

interface ErrorNoticeProps {
  readonly error: unknown;
  readonly texts: ErrorTexts;
  readonly onRetry?: (() => void) | undefined;
}

/** An error of the server as the reader needs it: the message, every problem of a file, the remedy. */
export function ErrorNotice({ error, texts, onRetry }: ErrorNoticeProps): JSX.Element {
  const { message, remedy } = describe(error, texts);
  const retry =
    onRetry === undefined ? undefined : (
      <Button size="xs" variant="default" onClick={onRetry}>
        {texts.retry}
      </Button>
    );
  const problems = error instanceof ApiError && error.remedy !== null ? error.details : [];
  // The remedy speaks of what is listed below it.
  const told =
    problems.length === 0 ? (
      remedy
    ) : (
      <>
        {remedy}
        <ul className={classes.problems}>
          {problems.map((one) => (
            <li key={`${one.line} ${one.path} ${one.message}`}>
              {problemText(one, texts.files?.line ?? "")}
            </li>
          ))}
        </ul>
      </>
    );
  return <Notice tone="bad" title={message} remedy={told} actions={retry} />;
}

/** A problem of a file in a line: its place, what is wrong, what to do. */
export function problemText(problem: Problem, lineWord: string): string {
  const { line, path, message, remedy } = problem;
  const numbered = typeof line === "number" && line > 0 ? `${lineWord} ${line}` : "";
  const place = [numbered, path ?? ""].filter((one) => one !== "").join(", ");
  const said = [message, remedy ?? ""].filter((one) => one !== "").join(" ");
  return place === "" ? said : `${place}: ${said}`;
}

/** Message and remedy of any failure; details, if any, are appended to the message. */
export function describe(
  error: unknown,
  texts: ErrorTexts,
): { readonly message: string; readonly remedy: string } {
  if (error instanceof ApiError) {
    const details = error.details.map((problem) => problem.message).join(" ");
    return { message: sentence(error.message), remedy: error.remedy ?? details };
  }
  if (error instanceof Unreachable) {
    return { message: texts.unreachable, remedy: texts.unreachableRemedy };
  }
  if (error instanceof FileChanged && texts.files !== undefined) {
    return { message: texts.files.changed(error.fileName), remedy: texts.files.changedRemedy };
  }
  // The page says beside it why, and what to do.
  if (isUnloaded(error)) return { message: texts.unloaded, remedy: "" };
  return { message: texts.unexpected, remedy: error instanceof Error ? error.message : "" };
}

/**
 * Capitalise a message: the server's start in lower case, because logs put words before them. A
 * name at the beginning, of a file or a column, stays as it is: only a plain word is capitalised.
 */
export const sentence = (message: string): string =>
  /^\p{Ll}+(?=[\s,;:’'-]|$)/u.test(message)
    ? message.charAt(0).toUpperCase() + message.slice(1)
    : message;
