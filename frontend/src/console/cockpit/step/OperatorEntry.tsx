/**
 * The questionnaire read aloud: the operator enters the answers, and the record says so. Where the
 * study has it read aloud, its questions stand in the step's card; elsewhere in a dialog.
 */
import { Center, Loader, Modal } from "@mantine/core";
import { sessions } from "@shared/api/endpoints";
import type { Administration, SessionView, Step } from "@shared/api/types";
import { EMPTY_DRAFT } from "@shared/forms/draft";
import { formTexts } from "@shared/forms/texts";
import { Boundary } from "@shared/ui/Boundary";
import { Notice } from "@shared/ui/Notice";
import { uuid } from "@shared/uuid";
import { useMutation, useQuery } from "@tanstack/react-query";
import { type JSX, lazy, Suspense, useState } from "react";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { Loaded } from "../../ui/Loaded";
import classes from "./CurrentStep.module.css";

const FormView = lazy(async () => ({ default: (await import("@shared/forms/FormView")).FormView }));

interface OperatorEntryProps {
  readonly session: SessionView;
  readonly step: Step | null;
  readonly opened: boolean;
  readonly onClose: () => void;
}

export function OperatorEntry({ session, step, opened, onClose }: OperatorEntryProps): JSX.Element {
  const { t } = useTexts();
  return (
    <Modal
      opened={opened}
      onClose={onClose}
      size={980}
      title={t("entry.title", { code: session.participant_code })}
      closeButtonProps={{ "aria-label": t("action.close") }}
      closeOnClickOutside={false}
    >
      {opened && <Entry session={session} stepKey={stepKeyOf(step)} onClose={onClose} />}
    </Modal>
  );
}

interface AloudProps {
  readonly session: SessionView;
  readonly step: Step;
}

/** The questions of a form that the study has read aloud, with the fields for their answers. */
export function Aloud({ session, step }: AloudProps): JSX.Element {
  const stepKey = stepKeyOf(step);
  return (
    <div className={classes.aloud}>
      <Entry key={stepKey} session={session} stepKey={stepKey} onClose={() => undefined} />
    </div>
  );
}

/** Whether this step's questions are read aloud and answered here, now. */
export const isAloud = (session: SessionView, step: Step | null): step is Step =>
  step?.forms === "oral" && session.allowed.includes("enter_answers");

const stepKeyOf = (step: Step | null): string => `${step?.key} ${step?.attempt}`;

interface EntryProps {
  readonly session: SessionView;
  readonly stepKey: string;
  readonly onClose: () => void;
}

function Entry({ session, stepKey, onClose }: EntryProps): JSX.Element {
  const { t } = useTexts();
  const query = useQuery({
    queryKey: ["administration", session.id, stepKey],
    queryFn: () => sessions.administration(session.id),
    // Fetched again whenever it is opened; cached, so that a draft survives an expired sign-in.
    refetchOnMount: "always",
    gcTime: 24 * 60 * 60_000,
  });
  return (
    <Loaded query={query}>
      {(administration) =>
        administration === null ? (
          <Notice tone="info" title={t("entry.none")} />
        ) : (
          <Boundary>
            <EntryForm session={session} administration={administration} onClose={onClose} />
          </Boundary>
        )
      }
    </Loaded>
  );
}

interface EntryFormProps {
  readonly session: SessionView;
  readonly administration: Administration;
  readonly onClose: () => void;
}

function EntryForm({ session, administration, onClose }: EntryFormProps): JSX.Element {
  const { t } = useTexts();
  const texts = formTexts(t);
  const [startedAt] = useState(() => new Date());
  const [draft, setDraft] = useState(EMPTY_DRAFT);
  // One key per form that is filled in: resending it after a lost answer stores it once.
  const [key] = useState(uuid);
  const save = useMutation({
    mutationFn: sessions.submit.bind(null, session.id),
    onSuccess: onClose,
  });
  return (
    <Suspense
      fallback={
        <Center mih={240}>
          <Loader />
        </Center>
      }
    >
      <Notice tone="info">{t("entry.recorded")}</Notice>
      {save.isError && <Failure error={save.error} />}
      <div style={{ marginTop: 16 }}>
        <FormView
          administration={administration}
          language={session.language}
          texts={texts}
          draft={draft}
          startedAt={startedAt}
          canOmit
          // Stored, the step is over; the form stays until the session says so.
          busy={save.isPending || save.isSuccess}
          onChange={setDraft}
          onSubmit={(answers, { timings, traces }) =>
            save.mutate({
              idempotency_key: key,
              administration: administration.key,
              answers,
              shown_order: administration.item_order,
              seed: administration.seed,
              language: session.language,
              started_at_utc: startedAt.toISOString(),
              timings,
              item_traces: traces,
            })
          }
        />
      </div>
    </Suspense>
  );
}
