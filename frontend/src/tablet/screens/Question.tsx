/** Below a text: a question that calls the experimenter, and the button for not taking part. */
import { Button } from "@mantine/core";
import { tablet } from "@shared/api/endpoints";
import type { TabletState } from "@shared/api/types";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { STATE_KEY } from "../useTabletState";

type Question = ReturnType<typeof useQuestion>;

/** Ask a question: it is an alarm on the experimenter's screen until somebody has come. */
export function useQuestion(state: TabletState) {
  const queries = useQueryClient();
  const call = useMutation({
    mutationFn: tablet.question,
    onSuccess: (answer) => queries.setQueryData(STATE_KEY, answer),
  });
  return { isAsked: state.question_asked, call };
}

/** The state of the question: whether the experimenter knows, or has to be spoken to. */
export function QuestionNotice({ question }: { readonly question: Question }): JSX.Element | null {
  const { t } = useTexts();
  const { isAsked, call } = question;
  if (call.isError) return <Notice tone="warn" icon="talk" title={t("help.failed")} />;
  if (!isAsked) return null;
  return (
    <Notice
      tone="info"
      icon="talk"
      title={t("ask.question.title")}
      actions={
        <Button
          size="sm"
          variant="default"
          loading={call.isPending}
          onClick={() => call.mutate(false)}
        >
          {t("help.takeBack")}
        </Button>
      }
    >
      {t("ask.question.body")}
    </Notice>
  );
}

interface QuestionButtonsProps {
  readonly question: Question;
  /** Missing if there is nothing to refuse. */
  readonly onRefuse?: (() => void) | undefined;
}

export function QuestionButtons({ question, onRefuse }: QuestionButtonsProps): JSX.Element {
  const { t } = useTexts();
  const { isAsked, call } = question;
  return (
    <div>
      <Button
        variant="subtle"
        color="gray"
        size="sm"
        disabled={isAsked}
        loading={call.isPending}
        onClick={() => call.mutate(true)}
      >
        {t("ask.question")}
      </Button>
      {onRefuse !== undefined && (
        <Button variant="subtle" color="gray" size="sm" onClick={onRefuse}>
          {t("ask.decline")}
        </Button>
      )}
    </div>
  );
}
