/** Why the last command was not carried out: refused, or overtaken by another operator. */
import { Button } from "@mantine/core";
import { Notice } from "@shared/ui/Notice";
import type { JSX } from "react";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import type { useSession } from "../session/useSession";

export function CommandFailure({
  live,
}: {
  readonly live: ReturnType<typeof useSession>;
}): JSX.Element | null {
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
