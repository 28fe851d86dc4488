/** Why the last command was not carried out: refused, or another operator was first. */
import { Button } from "@mantine/core";
import { Notice } from "@shared/ui/Notice";
import { type JSX, useEffect, useRef, useState } from "react";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import type { useSession } from "./useSession";

type Live = Pick<ReturnType<typeof useSession>, "error" | "overtaken" | "dismiss">;

interface CommandFailureProps {
  readonly live: Live;
}

export function CommandFailure({ live }: CommandFailureProps): JSX.Element | null {
  const { t } = useTexts();
  if (live.overtaken !== null) {
    const { command, changes } = live.overtaken;
    return (
      <Notice
        tone="warn"
        title={t("stale.title")}
        remedy={t("stale.remedy", { command: t(`command.${command.type}`) })}
        actions={
          <Button size="xs" variant="default" onClick={live.dismiss}>
            {t("action.understood")}
          </Button>
        }
      >
        {changes.map(({ key, values }) => t(key, values)).join(" ")}
      </Notice>
    );
  }
  return live.error === null ? null : <Failure error={live.error} />;
}

/**
 * For a dialog: failures since it was opened. Earlier ones belong to something else, and those
 * shown here have been read when the dialog is closed.
 */
export function NewFailure({ live }: CommandFailureProps): JSX.Element | null {
  const [before] = useState({ error: live.error, overtaken: live.overtaken });
  const error = live.error === before.error ? null : live.error;
  const overtaken = live.overtaken === before.overtaken ? null : live.overtaken;
  const leave = useRef(() => {});
  useEffect(() => {
    leave.current = error === null && overtaken === null ? () => {} : live.dismiss;
  });
  useEffect(() => () => leave.current(), []);
  return <CommandFailure live={{ error, overtaken, dismiss: live.dismiss }} />;
}
