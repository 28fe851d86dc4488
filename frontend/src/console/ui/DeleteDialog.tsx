/** A dialog that asks for confirmation before something is deleted for good. */
import { Button, Group, Modal, Stack, Text } from "@mantine/core";
import { useMutation } from "@tanstack/react-query";
import type { JSX } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";

interface DeleteDialogProps {
  readonly isOpen: boolean;
  readonly title: string;
  /** What is deleted, and what is kept. */
  readonly words: string;
  readonly onDelete: () => Promise<unknown>;
  readonly onClose: () => void;
  /** Called after the dialog has closed. */
  readonly onDeleted: () => unknown;
}

export function DeleteDialog(props: DeleteDialogProps): JSX.Element {
  const { isOpen, title, words, onDelete, onClose, onDeleted } = props;
  const { t } = useTexts();
  const remove = useMutation({
    mutationFn: onDelete,
    onSuccess: () => {
      onClose();
      return onDeleted();
    },
  });
  const close = () => {
    remove.reset();
    onClose();
  };
  return (
    <Modal
      opened={isOpen}
      onClose={close}
      title={title}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      <Stack>
        <Text>{words}</Text>
        {remove.isError && <Failure error={remove.error} />}
        <Group justify="flex-end">
          <Button variant="default" onClick={close}>
            {t("action.cancel")}
          </Button>
          <Button color="red" loading={remove.isPending} onClick={() => remove.mutate()}>
            {t("captures.delete.short")}
          </Button>
        </Group>
      </Stack>
    </Modal>
  );
}
