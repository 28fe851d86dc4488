/** In the header: how many files are being made; a click shows them all. */
import { ActionIcon, Button, Drawer, Indicator } from "@mantine/core";
import type { DataKind, SessionView } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { EmptyState } from "../ui/EmptyState";
import { DownloadList } from "./DownloadCard";
import classes from "./Downloads.module.css";
import {
  closeDownloads,
  isOpen,
  openDownloads,
  useAutomaticDownloads,
  useDownloads,
  useExports,
  useOrder,
} from "./useExports";

export function DownloadsButton(): JSX.Element {
  const { t } = useTexts();
  const { opened, requested } = useDownloads();
  // Nothing is requested while no file is expected and the list is closed.
  const query = useExports(opened || requested.length > 0);
  useAutomaticDownloads(query.isFetchedAfterMount ? query.data : undefined);
  const busy = query.data?.filter(isOpen).length ?? 0;
  return (
    <>
      <Indicator label={busy} size={16} disabled={busy === 0} processing offset={6}>
        <ActionIcon
          variant="subtle"
          color="gray"
          size="lg"
          data-tour="downloads"
          aria-label={busy === 0 ? t("downloads.open") : t("downloads.open.busy", { count: busy })}
          title={t("downloads.open")}
          onClick={openDownloads}
        >
          <Icon name="download" />
        </ActionIcon>
      </Indicator>
      <Drawer
        opened={opened}
        onClose={closeDownloads}
        position="right"
        size={440}
        title={t("downloads.title")}
        closeButtonProps={{ "aria-label": t("action.close") }}
      >
        <p className={classes.note}>{t("downloads.note")}</p>
        <DownloadList query={query} />
        {query.isError && query.data === undefined && (
          <Failure error={query.error} onRetry={() => void query.refetch()} />
        )}
        {query.data?.length === 0 && (
          <EmptyState icon="download" title={t("downloads.empty")}>
            {t("downloads.empty.body")}
          </EmptyState>
        )}
        {query.data?.some(({ fetched_at }) => fetched_at !== null) && (
          <p className={classes.note} style={{ marginTop: 14 }}>
            {t("downloads.browser")}
          </p>
        )}
      </Drawer>
    </>
  );
}

/** The download of a finished session: its own files, without the rest of the study. */
export function SessionDownload({
  session,
}: {
  readonly session: SessionView;
}): JSX.Element | null {
  const { t } = useTexts();
  const can = usePermissions();
  const order = useOrder();
  // An expert's session contains suggestions only, and is in no table.
  if (!can("compare") || session.kind === "expert") return null;
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
