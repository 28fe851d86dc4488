/** The reason for something that is recorded: a usual one to select, or a text. */
import { Chip, Group, Textarea } from "@mantine/core";
import type { JSX } from "react";
import { type Key, useTexts } from "../i18n";

interface ReasonFieldProps {
  readonly usual: readonly Key[];
  readonly value: string;
  readonly onChange: (reason: string) => void;
}

/** Enter submits the form that the field is in; Shift and Enter insert a line break. */
export function ReasonField({ usual, value, onChange }: ReasonFieldProps): JSX.Element {
  const { t } = useTexts();
  return (
    <>
      <Group gap="xs">
        {usual.map((key) => (
          <Chip key={key} checked={value === t(key)} onChange={() => onChange(t(key))}>
            {t(key)}
          </Chip>
        ))}
      </Group>
      <Textarea
        label={t("ask.reason")}
        data-autofocus
        autosize
        minRows={2}
        maxLength={500}
        value={value}
        onChange={(event) => onChange(event.currentTarget.value)}
        onKeyDown={(event) => {
          if (event.key !== "Enter" || event.shiftKey) return;
          event.preventDefault();
          event.currentTarget.form?.requestSubmit();
        }}
      />
    </>
  );
}
