/** The suggestions of the expert in the headset, stored with the step at which they were made. */
import { Button, NativeSelect, Stack, Textarea } from "@mantine/core";
import { suggestions } from "@shared/api/records";
import type { SessionView } from "@shared/api/types";
import { timeOfDay } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { usePermissions } from "../../permissions";
import { suggestionsQuery } from "../../queries";
import { stepName } from "../../steps";
import cockpit from "../Cockpit.module.css";
import classes from "../Panels.module.css";
import { currentStep } from "../session/action";

export function SuggestionsPanel({ session }: { readonly session: SessionView }): JSX.Element {
  const { t, language } = useTexts();
  const can = usePermissions();
  const all = useQuery(suggestionsQuery(session.study_key)).data ?? [];
  const own = all.filter((one) => one.session_id === session.id);
  return (
    <section>
      <h2 className={cockpit.sectionTitle}>
        <Icon name="talk" size={16} />
        {t("suggest.title")}
      </h2>
      {can("run") && <Write session={session} />}
      {own.length === 0 ? (
        <p className={classes.empty}>{t("suggest.none")}</p>
      ) : (
        <ol className={classes.notes}>
          {[...own].reverse().map((one) => (
            <li key={one.id} className={classes.note}>
              <time className={`${classes.when} numbers`} dateTime={one.at}>
                {timeOfDay(one.at, language)}
              </time>
              <span>
                <strong>{one.about_title ?? t("suggestions.whole")}</strong> {one.body}
              </span>
            </li>
          ))}
        </ol>
      )}
    </section>
  );
}

function Write({ session }: { readonly session: SessionView }): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const step = currentStep(session);
  const [body, setBody] = useState("");
  const [whole, setWhole] = useState(false);
  const add = useMutation({
    mutationFn: () =>
      suggestions.add(session.study_key, {
        session_id: session.id,
        about: whole ? "" : (step?.key ?? ""),
        body: body.trim(),
      }),
    onSuccess: () => {
      setBody("");
      void queries.invalidateQueries(suggestionsQuery(session.study_key));
    },
  });
  const choices = [
    ...(step === null
      ? []
      : [{ value: "step", label: t("suggest.thisStep", { step: t(stepName(step)) }) }]),
    { value: "whole", label: t("suggestions.whole") },
  ];
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        if (body.trim() !== "") add.mutate();
      }}
    >
      <Stack gap="xs">
        <Textarea
          label={t("suggest.write")}
          autosize
          minRows={2}
          maxLength={4000}
          value={body}
          onChange={(event) => setBody(event.currentTarget.value)}
        />
        <NativeSelect
          aria-label={t("suggest.about")}
          data={choices}
          value={whole || step === null ? "whole" : "step"}
          onChange={(event) => setWhole(event.currentTarget.value === "whole")}
        />
        {add.isError && <Failure error={add.error} />}
        <Button
          type="submit"
          variant="default"
          disabled={body.trim() === ""}
          loading={add.isPending}
        >
          {t("suggest.save")}
        </Button>
      </Stack>
    </form>
  );
}
