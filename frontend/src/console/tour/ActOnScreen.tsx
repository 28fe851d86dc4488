/** An empty page's offer to take the participant's place on this screen, with an explanation. */
import { Button } from "@mantine/core";
import type { StudyDetail } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { opened, useActOnScreen } from "./onScreen";
import classes from "./Tour.module.css";

interface ActOnScreenProps {
  readonly study: Pick<StudyDetail, "key" | "archived_at">;
}

export function ActOnScreen({ study }: ActOnScreenProps): JSX.Element | null {
  const { t } = useTexts();
  const can = usePermissions();
  const act = useActOnScreen();
  if (!can("run") || study.archived_at !== null) return null;
  return (
    <div className={classes.offer}>
      <Button
        variant="light"
        loading={act.isPending}
        leftSection={<Icon name="headset" size={18} />}
        onClick={() => act.mutate({ studyKey: study.key, tab: opened() })}
      >
        {t("acting.button")}
      </Button>
      <p>{t("acting.explain")}</p>
      {act.isError && <Failure error={act.error} />}
    </div>
  );
}
