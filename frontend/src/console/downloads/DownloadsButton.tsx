/** In the header: how many files are being made; a click shows them all. */
import { ActionIcon, Drawer, Indicator } from "@mantine/core";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { EmptyState } from "../ui/EmptyState";
import { DownloadList } from "./DownloadList";
import classes from "./Downloads.module.css";
import { closeDownloads, openDownloads, useDesk } from "./desk";
import { isOpen, useExports, useHandingOver } from "./useExports";

export function DownloadsButton(): JSX.Element {
  const { t } = useTexts();
  const { opened, wanted } = useDesk();
  // Nobody is asked while nothing was ordered and nobody looks.
  const query = useExports(opened || wanted.length > 0);
  useHandingOver(query.isFetchedAfterMount ? query.data : undefined);
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
