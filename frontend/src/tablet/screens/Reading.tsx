/** Consent and instructions: a text to read, a way to ask questions, and one button to continue. */
import { Button } from "@mantine/core";
import { tablet } from "@shared/api/endpoints";
import type { TabletState } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { STATE_KEY } from "../useTabletState";
import { Prose, ScrollHint } from "./Prose";
import { QuestionButtons, QuestionNotice, useQuestion } from "./Question";
import classes from "./screens.module.css";

interface ReadingProps {
  readonly state: TabletState;
  readonly screen: "consent" | "instructions";
  readonly onRefuse?: (() => void) | undefined;
}

export function Reading({ state, screen, onRefuse }: ReadingProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const question = useQuestion(state);
  const proceed = useMutation({
    mutationFn: () => tablet.acknowledge(state.step_index ?? 0),
    onSuccess: (answer) => queries.setQueryData(STATE_KEY, answer),
  });
  return (
    <article className={classes.reading}>
      <h1 className={classes.readingTitle}>{state.title ?? t(`${screen}.title`)}</h1>
      <Prose text={state.text ?? ""} />
      <div className={classes.ask} aria-live="polite">
        {screen === "instructions" && !question.isAsked && (
          <Notice tone="info" icon="talk" title={t("instructions.ask")}>
            {t("instructions.askBody")}
          </Notice>
        )}
        <QuestionNotice question={question} />
        {proceed.isError && <Failure error={proceed.error} onRetry={() => proceed.mutate()} />}
      </div>
      <ScrollHint />
      <div className={classes.foot}>
        <QuestionButtons question={question} onRefuse={onRefuse} />
        <Button
          size="lg"
          loading={proceed.isPending}
          rightSection={<Icon name="check" />}
          onClick={() => proceed.mutate()}
        >
          {t(`${screen}.go`)}
        </Button>
      </div>
    </article>
  );
}
