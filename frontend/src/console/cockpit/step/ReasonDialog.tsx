/**
 * A dialog that asks for the reason of an exception, which is recorded; common reasons are one key
 * away.
 */
import { Modal, Select, Stack, Text } from "@mantine/core";
import type { SessionView } from "@shared/api/types";
import { type JSX, useEffect, useState } from "react";
import { useTexts } from "../../i18n";
import { stepName } from "../../steps";
import { DialogButtons } from "../../ui/DialogButtons";
import { useShown } from "../../ui/page";
import { ReasonField } from "../../ui/ReasonField";
import {
  COMMON_REASONS,
  currentStep,
  type Reasoned,
  redoable,
  redoTarget,
} from "../session/action";
import { NewFailure } from "../session/CommandFailure";
import { stops, type useSession } from "../session/useSession";

interface ReasonDialogProps {
  readonly type: Reasoned | null;
  readonly session: SessionView;
  readonly live: ReturnType<typeof useSession>;
  readonly onClose: () => void;
}

export function ReasonDialog({ type, session, live, onClose }: ReasonDialogProps): JSX.Element {
  const { t } = useTexts();
  const named = useShown(type);
  // Back on the button that opened it, Enter would ask again instead of going on.
  const [isSent, setSent] = useState(false);
  useEffect(() => {
    if (type !== null) setSent(false);
  }, [type]);
  return (
    <Modal
      opened={type !== null}
      onClose={onClose}
      returnFocus={!isSent}
      title={named && t(`ask.${named}`)}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      {type !== null && (
        <ReasonForm
          type={type}
          session={session}
          live={live}
          onClose={onClose}
          onSent={() => {
            setSent(true);
            onClose();
          }}
        />
      )}
    </Modal>
  );
}

interface ReasonFormProps extends ReasonDialogProps {
  readonly type: Reasoned;
  readonly onSent: () => void;
}

function ReasonForm({ type, session, live, onClose, onSent }: ReasonFormProps): JSX.Element {
  const { t } = useTexts();
  const refused = type === "withdraw" && session.refusal !== null;
  const [reason, setReason] = useState(refused ? t("reason.refused") : "");
  const [step, setStep] = useState(() => redoTarget(session));
  // Skipping a consent is not like other steps: none of the usual reasons justifies it.
  const skipsConsent = type === "skip" && currentStep(session)?.kind === "consent";
  const grave = type === "abort" || type === "withdraw";
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        if (reason.trim() === "") return;
        const which = type === "redo" ? { step_index: step } : {};
        live.send({ type, reason: reason.trim(), ...which }, onSent);
      }}
    >
      <Stack>
        <Text c="dimmed">{t(skipsConsent ? "ask.skip.consent" : `ask.${type}.body`)}</Text>
        {type === "redo" && <RedoChoice session={session} step={step} onChange={setStep} />}
        <ReasonField
          usual={skipsConsent ? [] : COMMON_REASONS[type]}
          value={reason}
          onChange={setReason}
        />
        <NewFailure live={live} />
        <DialogButtons
          label={t(`do.${type}`)}
          isGrave={grave}
          isReady={reason.trim() !== ""}
          isSending={stops({ type }) ? live.stopping : live.sending}
          onCancel={onClose}
        />
      </Stack>
    </form>
  );
}

interface RedoChoiceProps {
  readonly session: SessionView;
  readonly step: number;
  readonly onChange: (step: number) => void;
}

/** From which step the session is repeated, and what that costs. */
function RedoChoice({ session, step, onChange }: RedoChoiceProps): JSX.Element {
  const { t } = useTexts();
  const steps = redoable(session).map(({ index, ...one }) => ({
    value: String(index),
    label: t("redo.step", { number: index + 1, name: t(stepName(one)) }),
  }));
  const last = session.current?.index ?? step;
  return (
    <Select
      label={t("redo.from")}
      description={last > step ? t("redo.also", { count: last - step }) : undefined}
      data={steps.reverse()}
      value={String(step)}
      allowDeselect={false}
      onChange={(value) => value !== null && onChange(Number(value))}
    />
  );
}
