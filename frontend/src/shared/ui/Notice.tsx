/** A short message on the page: what the problem is, and what to do about it. */
import { Button } from "@mantine/core";
import type { JSX, ReactNode } from "react";
import { ApiError, Unreachable } from "../api/request";
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
}

/** A page's own wording of errors, which it keeps under these keys. */
export const errorTexts = (
  t: (key: `error.${Exclude<keyof ErrorTexts, "unloaded">}` | "page.unknown") => string,
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

/** An error of the server as the reader needs it: the message, the value, the remedy. */
export function ErrorNotice({ error, texts, onRetry }: ErrorNoticeProps): JSX.Element {
  const { message, remedy } = describe(error, texts);
  const retry =
    onRetry === undefined ? undefined : (
      <Button size="xs" variant="default" onClick={onRetry}>
        {texts.retry}
      </Button>
    );
  return <Notice tone="bad" title={message} remedy={remedy} actions={retry} />;
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
  // The page says beside it why, and what to do.
  if (isUnloaded(error)) return { message: texts.unloaded, remedy: "" };
  return { message: texts.unexpected, remedy: error instanceof Error ? error.message : "" };
}

/** Capitalise a message: the server's start in lower case, because logs put words before them. */
const sentence = (message: string): string => message.charAt(0).toUpperCase() + message.slice(1);
