/** From which step on the session is done over, and what that costs. */
import { Select } from "@mantine/core";
import type { SessionView } from "@shared/api/types";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { stepName } from "../../steps";
import { redoable } from "../session/redo";

interface RedoChoiceProps {
  readonly session: SessionView;
  readonly step: number;
  readonly onChange: (step: number) => void;
}

export function RedoChoice({ session, step, onChange }: RedoChoiceProps): JSX.Element {
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
