/** A form; every answer is kept on the tablet until the server has stored it. */
import { Button, Center, Loader } from "@mantine/core";
import type { Administration, TabletState } from "@shared/api/types";
import { FormView } from "@shared/forms/FormView";
import { formTexts } from "@shared/forms/texts";
import { Notice } from "@shared/ui/Notice";
import type { JSX } from "react";
import { type FormPhase, useStoredForm } from "../drafts/useStored";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import classes from "./screens.module.css";

interface FormScreenProps {
  readonly state: TabletState;
  readonly administration: Administration;
  readonly show: (next: TabletState) => void;
  readonly refresh: () => void;
}

export function FormScreen({ state, administration, show, refresh }: FormScreenProps): JSX.Element {
  const { t } = useTexts();
  const texts = formTexts(t);
  const form = useStoredForm(state.session_id, administration, state.language, show, refresh);
  const { phase } = form;
  if (phase.name !== "filling") return <FormStatus phase={phase} retry={form.retry} />;
  return (
    <>
      {phase.refused !== null && <Failure error={phase.refused} />}
      <FormView
        administration={administration}
        language={state.language}
        texts={texts}
        draft={phase.form.draft}
        begun={phase.begun}
        startedAt={new Date(phase.form.startedAt)}
        busy={false}
        onChange={form.storeDraft}
        onSubmit={form.send}
      />
    </>
  );
}

function Opening(): JSX.Element {
  return (
    <Center flex={1}>
      <Loader />
    </Center>
  );
}

interface FormStatusProps {
  readonly phase: Exclude<FormPhase, { name: "filling" }>;
  readonly retry: () => void;
}

/** The screen before the form has loaded, and after it was sent. */
function FormStatus({ phase, retry }: FormStatusProps): JSX.Element {
  const { t } = useTexts();
  switch (phase.name) {
    case "opening":
      return <Opening />;
    case "sending":
      return (
        <div className={classes.calm} role="status">
          <Loader type="dots" size="lg" />
          <h1 className={classes.calmTitle}>
            {t(phase.offline ? "sending.offline" : "sending.title")}
          </h1>
          <p className={classes.calmText}>
            {t(phase.offline ? "sending.offlineBody" : "sending.body")}
          </p>
        </div>
      );
    case "held":
      return (
        <div className={classes.calm}>
          <Notice
            tone="warn"
            title={t("held.title")}
            actions={
              <Button variant="default" onClick={retry}>
                {t("error.retry")}
              </Button>
            }
          >
            {t("held.body")}
          </Notice>
        </div>
      );
    case "done":
      return (
        <div className={classes.calm} role="status">
          <h1 className={classes.calmTitle}>{t("sent.title")}</h1>
          <p className={classes.calmText}>{t("sent.body")}</p>
        </div>
      );
  }
}
