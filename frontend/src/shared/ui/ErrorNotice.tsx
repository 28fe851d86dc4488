/** An error of the server as the reader needs it: the message, the value, what to do. */
import { Button } from "@mantine/core";
import type { JSX } from "react";
import { ApiError, Unreachable } from "../api/errors";
import { Notice } from "./Notice";

export interface ErrorTexts {
  readonly unreachable: string;
  readonly unreachableRemedy: string;
  readonly unexpected: string;
  readonly retry: string;
}

interface ErrorNoticeProps {
  readonly error: unknown;
  readonly texts: ErrorTexts;
  readonly onRetry?: (() => void) | undefined;
}

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

/** Message and remedy of any failure; details are joined to the message where there are any. */
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
  return { message: texts.unexpected, remedy: error instanceof Error ? error.message : "" };
}

/** The server's messages begin in lower case, because logs put words before them. */
const sentence = (message: string): string => message.charAt(0).toUpperCase() + message.slice(1);
