/** All captures of the lab, and the upload of new ones. */
import { Text, TextInput, Title } from "@mantine/core";
import type { CaptureListed, CapturePage } from "@shared/api/captures";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { nameOf } from "../account";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { EmptyState } from "../ui/EmptyState";
import { Loaded } from "../ui/Loaded";
import { useTitle } from "../ui/page";
import classes from "./Captures.module.css";
import { CaptureTable } from "./CaptureTable";
import { DeleteCapture } from "./DeleteCapture";
import { DropZone, Formats, useFormatName } from "./DropZone";
import { capturesQuery } from "./queries";
import { UploadList } from "./UploadList";
import { useUploads } from "./useUploads";

export function CapturesPage(): JSX.Element {
  const { t } = useTexts();
  useTitle(t("captures.title"));
  const canWrite = usePermissions()("capture");
  const uploads = useUploads();
  const query = useQuery(capturesQuery);
  return (
    <>
      <div className={classes.head}>
        <div>
          <Title order={1}>{t("captures.title")}</Title>
          <Text c="dimmed">{t("captures.lead")}</Text>
        </div>
      </div>
      {canWrite && <DropZone onFiles={uploads.add} />}
      <UploadList uploads={uploads} />
      <Loaded query={query}>
        {(page) =>
          page.total === 0 ? <NoCaptures canWrite={canWrite} /> : <CaptureList page={page} />
        }
      </Loaded>
    </>
  );
}

function NoCaptures({ canWrite }: { readonly canWrite: boolean }): JSX.Element {
  const { t } = useTexts();
  return (
    <EmptyState icon="walk" title={t("captures.empty")} action={<Formats />}>
      {t(canWrite ? "captures.empty.body" : "captures.empty.reader")}
    </EmptyState>
  );
}

function CaptureList({ page }: { readonly page: CapturePage }): JSX.Element {
  const { t } = useTexts();
  const canWrite = usePermissions()("capture");
  const formatName = useFormatName();
  const [search, setSearch] = useState("");
  const [leaving, setLeaving] = useState<CaptureListed | null>(null);
  const shown = page.captures.filter((one) =>
    [one.title, one.file_name, one.companion_name ?? "", formatName(one.format), nameOf(one.by)]
      .join(" ")
      .toLowerCase()
      .includes(search.trim().toLowerCase()),
  );
  const counted =
    search.trim() === ""
      ? t("captures.count", { count: page.total })
      : t("captures.counted", { shown: shown.length, total: page.captures.length });
  return (
    <>
      <div className={classes.toolbar}>
        <TextInput
          aria-label={t("captures.search")}
          placeholder={t("captures.search")}
          type="search"
          value={search}
          onChange={(event) => setSearch(event.currentTarget.value)}
        />
        <span className={`${classes.soft} numbers`} role="status">
          {counted}
        </span>
      </div>
      {shown.length === 0 ? (
        <EmptyState icon="walk" title={t("captures.none")}>
          {t("captures.none.body")}
        </EmptyState>
      ) : (
        <CaptureTable captures={shown} onDelete={canWrite ? setLeaving : null} />
      )}
      {page.total > page.captures.length && (
        <Text c="dimmed" mt="sm">
          {t("captures.older", { shown: page.captures.length, total: page.total })}
        </Text>
      )}
      {canWrite && (
        <details className={classes.help}>
          <summary>{t("captures.formats")}</summary>
          <Formats />
        </details>
      )}
      <DeleteCapture capture={leaving} onClose={() => setLeaving(null)} />
    </>
  );
}
