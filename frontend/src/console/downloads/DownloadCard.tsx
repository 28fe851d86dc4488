/** One file: what it is, its progress, and what can be done with it. */
import { ActionIcon, Button, CopyButton, Progress } from "@mantine/core";
import { type Export, exports } from "@shared/api/housekeeping";
import { bytes, duration, number, timeOfDay } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { seconds } from "@shared/units";
import { type UseQueryResult, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { exportsQuery } from "../queries";
import classes from "./Downloads.module.css";
import { isOpen, useDownloads, useOrder, useRemoval } from "./useExports";

function DownloadCard({ one }: { readonly one: Export }): JSX.Element {
  const removal = useRemoval();
  return (
    <li className={classes.card} data-state={one.state}>
      {one.state === "failed" ? (
        <Failed one={one} onRemove={() => removal.mutate(one.id)} />
      ) : (
        <>
          <DownloadTitle one={one} />
          {one.state === "ready" ? (
            <Ready one={one} onRemove={() => removal.mutate(one.id)} />
          ) : (
            <DownloadProgress
              one={one}
              cancelling={removal.isPending}
              onCancel={() => removal.mutate(one.id)}
            />
          )}
        </>
      )}
      {removal.isError && <Failure error={removal.error} />}
    </li>
  );
}

function DownloadTitle({ one }: { readonly one: Export }): JSX.Element {
  const { t } = useTexts();
  const kind = t(one.kind === "all" ? "downloads.kind.all" : `kind.${one.kind}`);
  return (
    <div>
      <div className={classes.name}>{one.file_name}</div>
      <div className={classes.soft}>
        {one.study_key}
        {" · "}
        {one.session_id === null ? t("downloads.kind", { kind }) : t("downloads.session")}
      </div>
    </div>
  );
}

interface DownloadProgressProps {
  readonly one: Export;
  readonly cancelling: boolean;
  readonly onCancel: () => void;
}

function DownloadProgress({ one, cancelling, onCancel }: DownloadProgressProps): JSX.Element {
  const { t } = useTexts();
  const hasProgress = one.rows_total > 0 && one.rows > 0;
  return (
    <>
      {one.state === "making" && (
        <Progress
          value={hasProgress ? Math.min(100, (one.rows / one.rows_total) * 100) : 100}
          animated={!hasProgress}
          aria-label={t("downloads.progress", { name: one.file_name })}
        />
      )}
      <div className={classes.row}>
        <Figures one={one} />
        <Button size="xs" variant="default" loading={cancelling} onClick={onCancel}>
          {t("downloads.cancel")}
        </Button>
      </div>
    </>
  );
}

function Figures({ one }: { readonly one: Export }): JSX.Element {
  const { t, language } = useTexts();
  if (one.state === "queued") return <div className={classes.soft}>{t("downloads.queued")}</div>;
  if (one.bytes === 0) return <div className={classes.soft}>{t("downloads.beginning")}</div>;
  const size = bytes(one.bytes, language);
  const amount =
    one.bytes_expected === null
      ? t("downloads.bytes", { size })
      : t("downloads.bytesOf", { size, total: bytes(one.bytes_expected, language) });
  const count = (value: number) => number(value, language, 0);
  const facts = [
    one.bytes_per_s !== null && t("downloads.rate", { rate: bytes(one.bytes_per_s, language) }),
    one.remaining_s !== null &&
      t("downloads.left", { time: duration(seconds(Math.max(1, one.remaining_s))) }),
    t("downloads.sessions", { done: count(one.sessions), total: count(one.sessions_total) }),
    one.rows_total > 0 &&
      t("downloads.rows", { done: count(one.rows), total: count(one.rows_total) }),
  ].filter((fact) => fact !== false);
  return (
    <div className="numbers">
      <div>{amount}</div>
      <div className={classes.soft}>{facts.join(" · ")}</div>
    </div>
  );
}

interface EndedProps {
  readonly one: Export;
  readonly onRemove: () => void;
}

function Ready({ one, onRemove }: EndedProps): JSX.Element {
  const { t, language } = useTexts();
  const queries = useQueryClient();
  const size = bytes(one.bytes, language);
  const facts = [
    t("downloads.made", { time: duration(seconds(Math.max(1, one.elapsed_s))) }),
    one.expires_at !== null &&
      t("downloads.until", { time: timeOfDay(one.expires_at, language).slice(0, 5) }),
  ].filter((fact) => fact !== false);
  return (
    <>
      <div className={classes.row}>
        <div className="numbers">
          <div className={classes.done}>
            <Icon name="check" size={18} />
            {t(one.fetched_at === null ? "downloads.ready" : "downloads.sent", { size })}
          </div>
          <div className={classes.soft}>{facts.join(" · ")}</div>
        </div>
        <div className={classes.actions}>
          <Button
            size="xs"
            component="a"
            href={exports.fileUrl(one.id)}
            download={one.file_name}
            variant={one.fetched_at === null ? "filled" : "default"}
            leftSection={<Icon name="download" size={16} />}
            onClick={() =>
              setTimeout(
                () => void queries.invalidateQueries({ queryKey: exportsQuery.queryKey }),
                1000,
              )
            }
          >
            {t(one.fetched_at === null ? "downloads.save" : "downloads.saveAgain")}
          </Button>
          <ActionIcon
            variant="subtle"
            color="gray"
            aria-label={t("downloads.remove")}
            title={t("downloads.remove")}
            onClick={onRemove}
          >
            <Icon name="close" size={16} />
          </ActionIcon>
        </div>
      </div>
      {one.sha256 !== null && <Checksum sha256={one.sha256} />}
    </>
  );
}

function Checksum({ sha256 }: { readonly sha256: string }): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.checksum}>
      <span>{t("downloads.checksum")}</span>
      <code>{sha256}</code>
      <CopyButton value={sha256}>
        {({ copied, copy }) => (
          <Button
            size="compact-xs"
            variant="subtle"
            onClick={copy}
            title={t("downloads.checksum.copy")}
          >
            {t(copied ? "action.copied" : "action.copy")}
          </Button>
        )}
      </CopyButton>
    </div>
  );
}

function Failed({ one, onRemove }: EndedProps): JSX.Element {
  const { t } = useTexts();
  const order = useOrder();
  const retry = () =>
    order.mutate(
      {
        studyKey: one.study_key,
        kind: one.kind,
        ...(one.session_id === null ? {} : { sessionId: one.session_id }),
      },
      { onSuccess: onRemove },
    );
  return (
    <>
      <Notice
        tone="bad"
        title={t("downloads.failed", { name: one.file_name })}
        remedy={one.trouble?.remedy}
        actions={
          <div className={classes.actions}>
            <Button size="xs" variant="default" loading={order.isPending} onClick={retry}>
              {t("downloads.again")}
            </Button>
            <Button size="xs" variant="subtle" color="gray" onClick={onRemove}>
              {t("downloads.remove")}
            </Button>
          </div>
        }
      >
        {one.trouble?.message}
      </Notice>
      {order.isError && <Failure error={order.error} />}
    </>
  );
}

interface DownloadListProps {
  readonly query: UseQueryResult<readonly Export[]>;
  readonly studyKey?: string;
}

/** The account's files, newest first; only those of one study on that study's pages. */
export function DownloadList({ query, studyKey }: DownloadListProps): JSX.Element | null {
  const { t } = useTexts();
  const { hasVanished } = useDownloads();
  const shown = (query.data ?? []).filter(
    (one) => studyKey === undefined || one.study_key === studyKey,
  );
  const connectionLost = query.isError && shown.some(isOpen);
  if (shown.length === 0 && !hasVanished) return null;
  return (
    <div>
      {(connectionLost || hasVanished) && (
        <div className={classes.notices}>
          {connectionLost && (
            <Notice tone="warn" title={t("downloads.lost")}>
              {t("downloads.lost.body")}
            </Notice>
          )}
          {hasVanished && (
            <Notice tone="warn" title={t("downloads.gone")}>
              {t("downloads.gone.body")}
            </Notice>
          )}
        </div>
      )}
      <ul className={classes.list}>
        {shown.map((one) => (
          <DownloadCard key={one.id} one={one} />
        ))}
      </ul>
    </div>
  );
}
