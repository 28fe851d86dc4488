/** A dialog that asks for confirmation before a capture is deleted for good. */
import { Button, Group, Modal, Stack, Text } from "@mantine/core";
import { captures } from "@shared/api/captures";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { useShown } from "../ui/page";
import { capturesQuery } from "./queries";

interface DeleteCaptureProps {
  /** Null closes the dialog. */
  readonly capture: { readonly id: string; readonly title: string } | null;
  readonly onClose: () => void;
  readonly onDeleted?: () => void;
}

export function DeleteCapture({ capture, onClose, onDeleted }: DeleteCaptureProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const shown = useShown(capture);
  const remove = useMutation({
    mutationFn: (id: string) => captures.remove(id),
    onSuccess: async (_, id) => {
      onClose();
      onDeleted?.();
      queries.removeQueries({ queryKey: ["captures", id] });
      await queries.invalidateQueries({ queryKey: capturesQuery.queryKey, exact: true });
    },
  });
  const close = () => {
    remove.reset();
    onClose();
  };
  return (
    <Modal
      opened={capture !== null}
      onClose={close}
      title={t("captures.delete.title")}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      <Stack>
        <Text>{t("captures.delete.body", { name: shown?.title ?? "" })}</Text>
        {remove.isError && <Failure error={remove.error} />}
        <Group justify="flex-end">
          <Button variant="default" onClick={close}>
            {t("action.cancel")}
          </Button>
          <Button
            color="red"
            loading={remove.isPending}
            onClick={() => capture !== null && remove.mutate(capture.id)}
          >
            {t("captures.delete.short")}
          </Button>
        </Group>
      </Stack>
    </Modal>
  );
}
