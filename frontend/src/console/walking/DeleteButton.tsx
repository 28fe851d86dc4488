/** A button that deletes an item of this page, after a confirmation. */
import { Button, Group, Modal, Stack, Text } from "@mantine/core";
import { type QueryKey, useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";

interface DeleteButtonProps {
  readonly title: string;
  readonly remove: () => Promise<unknown>;
  readonly changes: QueryKey;
  readonly onDone?: () => void;
}

export function DeleteButton({ title, remove, changes, onDone }: DeleteButtonProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [asking, setAsking] = useState(false);
  const act = useMutation({
    mutationFn: remove,
    onSuccess: async () => {
      setAsking(false);
      onDone?.();
      await queries.invalidateQueries({ queryKey: changes });
    },
  });
  const close = () => {
    act.reset();
    setAsking(false);
  };
  return (
    <>
      <Button
        size="compact-sm"
        variant="subtle"
        color="gray"
        aria-label={t("walking.delete.of", { title })}
        onClick={() => setAsking(true)}
      >
        {t("walking.delete")}
      </Button>
      <Modal
        opened={asking}
        onClose={close}
        title={t("walking.delete.title")}
        closeButtonProps={{ "aria-label": t("action.close") }}
      >
        <Stack>
          <Text>{t("walking.delete.body", { title })}</Text>
          {act.isError && <Failure error={act.error} />}
          <Group justify="flex-end">
            <Button variant="default" onClick={close}>
              {t("action.cancel")}
            </Button>
            <Button color="red" loading={act.isPending} onClick={() => act.mutate()}>
              {t("walking.delete")}
            </Button>
          </Group>
        </Stack>
      </Modal>
    </>
  );
}
