/** Consent and instructions: a text to read, room for questions, and one button to go on. */
import { Button } from "@mantine/core";
import { tablet } from "@shared/api/endpoints";
import type { TabletState } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { STATE_KEY } from "../useTabletState";
import { Prose, ScrollHint } from "./Prose";
import classes from "./screens.module.css";

interface ReadingProps {
  readonly state: TabletState;
  readonly screen: "consent" | "instructions";
}

export function Reading({ state, screen }: ReadingProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [asking, setAsking] = useState<"question" | "decline" | null>(null);
  const goOn = useMutation({
    mutationFn: () => tablet.acknowledge(state.step_index ?? 0),
    onSuccess: (answer) => queries.setQueryData(STATE_KEY, answer),
  });
  return (
    <article className={classes.reading}>
      <h1 className={classes.readingTitle}>{state.title ?? t(`${screen}.title`)}</h1>
      <Prose text={state.text ?? ""} />
      <div className={classes.ask} aria-live="polite">
        {screen === "instructions" && asking === null && (
          <Notice tone="info" icon="talk" title={t("instructions.ask")}>
            {t("instructions.askBody")}
          </Notice>
        )}
        {asking !== null && (
          <Notice tone="info" icon="talk" title={t(`ask.${asking}.title`)}>
            {t(`ask.${asking}.body`)}
          </Notice>
        )}
        {goOn.isError && <Failure error={goOn.error} onRetry={() => goOn.mutate()} />}
      </div>
      <ScrollHint />
      <div className={classes.foot}>
        <div>
          <Button variant="subtle" color="gray" size="sm" onClick={() => setAsking("question")}>
            {t("ask.question")}
          </Button>
          {screen === "consent" && (
            <Button variant="subtle" color="gray" size="sm" onClick={() => setAsking("decline")}>
              {t("ask.decline")}
            </Button>
          )}
        </div>
        <Button
          size="lg"
          loading={goOn.isPending}
          rightSection={<Icon name="check" />}
          onClick={() => goOn.mutate()}
        >
          {t(`${screen}.go`)}
        </Button>
      </div>
    </article>
  );
}
