/** On a session that is over: its own files, without the rest of the study. */
import { Button } from "@mantine/core";
import type { DataKind, SessionView } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { useMay } from "../may";
import { openDownloads } from "./desk";
import { useOrder } from "./useExports";

export function SessionDownload({
  session,
}: {
  readonly session: SessionView;
}): JSX.Element | null {
  const { t } = useTexts();
  const may = useMay();
  const order = useOrder();
  // An expert's session is advice, and in no table.
  if (!may("compare") || session.kind === "expert") return null;
  const kind: DataKind = session.kind;
  return (
    <>
      <Button
        variant="subtle"
        size="compact-sm"
        data-tour="csv"
        ml="auto"
        loading={order.isPending}
        leftSection={<Icon name="download" size={15} />}
        onClick={() =>
          order.mutate(
            { studyKey: session.study_key, kind, sessionId: session.id },
            { onSuccess: openDownloads },
          )
        }
      >
        {t("downloads.thisSession")}
      </Button>
      {order.isError && <Failure error={order.error} />}
    </>
  );
}
