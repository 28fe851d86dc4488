/** Pausing is instant; why is said afterwards, while the clock stands, and kept as a note. */
import { Button } from "@mantine/core";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { COMMON_REASONS } from "../session/reasons";
import type { useSession } from "../session/useSession";
import classes from "./CurrentStep.module.css";

export function PauseReason({
  live,
}: {
  readonly live: ReturnType<typeof useSession>;
}): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.why}>
      <span>{t("pause.why")}</span>
      {COMMON_REASONS.pause.map((key) => (
        <Button
          key={key}
          size="compact-sm"
          variant="default"
          radius="xl"
          disabled={live.sending}
          onClick={() => live.send({ type: "note", text: t("pause.note", { reason: t(key) }) })}
        >
          {t(key)}
        </Button>
      ))}
    </div>
  );
}
