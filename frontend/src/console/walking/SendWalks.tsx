/** Send a form of new walks, and the button that does it. */
import { Button, Group } from "@mantine/core";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { useSingleSubmit } from "../ui/useSingleSubmit";
import { walkSetsQuery } from "./queries";
import classes from "./Walking.module.css";

export interface SourceProps {
  readonly title: string;
  readonly onDone: () => void;
}

/** Send a form, and reload the list if it was accepted. */
export function useSending(send: () => Promise<unknown>, onDone: () => void) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: send,
    onSuccess: async () => {
      await queries.invalidateQueries({ queryKey: walkSetsQuery.queryKey });
      onDone();
    },
  });
}

interface SendProps {
  readonly sending: ReturnType<typeof useSending>;
  readonly ready: boolean;
}

export function Send({ sending, ready }: SendProps): JSX.Element {
  const { t } = useTexts();
  const submit = useSingleSubmit(sending);
  return (
    <div className={classes.dialogButtons}>
      {sending.isError && <Failure error={sending.error} />}
      <Group justify="flex-end">
        <Button loading={sending.isPending} disabled={!ready} onClick={() => submit()}>
          {t("walking.sets.add")}
        </Button>
      </Group>
    </div>
  );
}
