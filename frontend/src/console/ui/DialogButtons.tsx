/** The buttons at the end of a dialog's form: cancel, and the one that sends it. */
import { Button, Group } from "@mantine/core";
import type { JSX } from "react";
import { useTexts } from "../i18n";

interface DialogButtonsProps {
  readonly label: string;
  /** What cannot be taken back is red. */
  readonly isGrave: boolean;
  readonly isReady: boolean;
  readonly isSending: boolean;
  readonly onCancel: () => void;
}

export function DialogButtons(props: DialogButtonsProps): JSX.Element {
  const { label, isGrave, isReady, isSending, onCancel } = props;
  const { t } = useTexts();
  return (
    <Group justify="flex-end">
      <Button variant="default" onClick={onCancel}>
        {t("action.cancel")}
      </Button>
      <Button
        type="submit"
        color={isGrave ? "red" : "petrol"}
        disabled={!isReady}
        loading={isSending}
      >
        {label}
      </Button>
    </Group>
  );
}
