/** What takes how much space, and how many more sessions fit. */
import { Button, Paper, Text, Title } from "@mantine/core";
import { type StoragePart, type StorageRoom, storageRoom } from "@shared/api/housekeeping";
import { bytes, dateTime, timeOfDay } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { Copyable } from "../pages/network/Copyable";
import { storageQuery } from "../queries";
import { Loaded } from "../ui/Loaded";
import { useTitle } from "../ui/page";
import { diskShares } from "./figures";
import classes from "./Storage.module.css";
import { LargestSessions, StudySizes } from "./StudySizes";

export function StoragePage(): JSX.Element {
  const { t, language } = useTexts();
  const queries = useQueryClient();
  const query = useQuery(storageQuery);
  const measure = useMutation({
    mutationFn: () => storageRoom.get(true),
    onSuccess: (room) => queries.setQueryData(storageQuery.queryKey, room),
  });
  useTitle(t("storage.title"));
  return (
    <>
      <div className={classes.head}>
        <div>
          <Title order={1}>{t("storage.title")}</Title>
          <Text c="dimmed">{t("storage.lead")}</Text>
        </div>
        <div className={classes.measure}>
          {query.data !== undefined && (
            <span className="numbers">
              {t("storage.measured", { time: timeOfDay(query.data.measured_at, language) })}
            </span>
          )}
          <Button
            variant="default"
            loading={measure.isPending}
            leftSection={<Icon name="redo" size={16} />}
            onClick={() => measure.mutate()}
          >
            {t("storage.measure")}
          </Button>
        </div>
      </div>
      {measure.isError && <Failure error={measure.error} />}
      <Loaded query={query}>{(room) => <DiskSpace room={room} />}</Loaded>
    </>
  );
}

function DiskSpace({ room }: { readonly room: StorageRoom }): JSX.Element {
  const { t, language } = useTexts();
  const size = (value: number): string => bytes(value, language);
  return (
    <div className={classes.page}>
      {room.disk.is_low && (
        <Notice tone="bad" title={t("storage.low")}>
          {t("storage.low.body", {
            free: size(room.disk.free_bytes),
            limit: size(room.disk.warn_below_bytes),
          })}
        </Notice>
      )}
      {!room.disk.holds_database && (
        <Notice tone="info" title={t("storage.elsewhere")}>
          {t("storage.elsewhere.body")}
        </Notice>
      )}
      <div className={classes.grid}>
        <Paper>
          <Title order={2}>{t("storage.disk")}</Title>
          <DiskBar room={room} />
          <div className={classes.folder}>
            <span>{t("storage.folder")}</span> <code>{room.place}</code>
          </div>
        </Paper>
        <Paper>
          <Title order={2} mb="xs">
            {t("storage.backup")}
          </Title>
          <p className={classes.text}>{t("storage.backup.body")}</p>
          <Copyable text="./run backup FILE" />
          <p className={classes.soft}>{t("storage.backup.docs")}</p>
        </Paper>
        {room.half_made.length > 0 && (
          <Paper className={classes.wide ?? ""}>
            <Title order={2}>{t("storage.halfMade")}</Title>
            <UnfinishedFiles found={room.half_made} />
            <p className={classes.soft}>{t("storage.halfMade.note")}</p>
          </Paper>
        )}
        <Paper className={classes.wide ?? ""}>
          <Title order={2}>{t("storage.studies")}</Title>
          <StudySizes studies={room.studies} />
        </Paper>
        <Paper>
          <Title order={2}>{t("storage.parts")}</Title>
          <Parts parts={room.parts} />
          <p className={classes.soft}>{t(`storage.method.${room.method}`)}</p>
        </Paper>
        <Paper>
          <div className={classes.titleRow}>
            <Title order={2}>{t("storage.sessions")}</Title>
            {room.sessions_total > room.sessions.length && (
              <span className={`${classes.soft} numbers`}>
                {t("storage.sessions.of", {
                  shown: room.sessions.length,
                  total: room.sessions_total,
                })}
              </span>
            )}
          </div>
          <LargestSessions sessions={room.sessions} />
        </Paper>
      </div>
    </div>
  );
}

/** The disk as one bar, with a mark at which the warning starts. */
function DiskBar({ room }: { readonly room: StorageRoom }): JSX.Element {
  const { t, language } = useTexts();
  const shares = diskShares(room);
  const size = (value: number): string => bytes(value, language);
  const percent = (value: number): string => `${(100 * value) / Math.max(1, shares.total)}%`;
  const limit = room.disk.warn_below_bytes;
  const sizes = { own: size(shares.own), other: size(shares.other), free: size(shares.free) };
  return (
    <>
      <p className={`${classes.free} numbers`}>
        {t("storage.disk.free", { free: sizes.free, total: size(shares.total) })}
      </p>
      <div className={classes.bar} role="img" aria-label={t("storage.disk.bar", sizes)}>
        <span className={classes.own} style={{ width: percent(shares.own) }} />
        <span className={classes.other} style={{ width: percent(shares.other) }} />
        <span className={classes.mark} style={{ insetInlineEnd: percent(limit) }} />
      </div>
      <ul className={`${classes.legend} numbers`}>
        <li>
          <span className={classes.own} />
          {t("storage.disk.own")} {sizes.own}
        </li>
        <li>
          <span className={classes.other} />
          {t("storage.disk.other")} {sizes.other}
        </li>
        <li>
          <span className={classes.markKey} />
          {t("storage.disk.kept", { limit: size(limit) })}
        </li>
      </ul>
    </>
  );
}

/** Files that a crash left unfinished, or that a command is writing now. */
function UnfinishedFiles({ found }: { readonly found: StorageRoom["half_made"] }): JSX.Element {
  const { t, language } = useTexts();
  return (
    <ul className={classes.halfMade}>
      {found.map((one) => (
        <li key={one.place}>
          <div>
            {t(`storage.halfMade.${one.kind}`)}
            <span className={classes.about}>
              {t(one.going_on ? "storage.halfMade.goingOn" : "storage.halfMade.left", {
                time: dateTime(one.since, language),
              })}
            </span>
          </div>
          <code>{one.place}</code>
        </li>
      ))}
    </ul>
  );
}

/** Each part with its size, largest first, as bars on one scale. */
function Parts({ parts }: { readonly parts: readonly StoragePart[] }): JSX.Element {
  const { t, language } = useTexts();
  const most = Math.max(1, ...parts.map((part) => part.bytes));
  return (
    <ul className={classes.parts}>
      {parts.map((part) => (
        <li key={part.place}>
          <div className={classes.partName}>
            {t(`storage.part.${part.place}`)}
            <span className={classes.about}>{t(`storage.part.${part.place}.about`)}</span>
          </div>
          <div className={`${classes.partSize} numbers`}>
            {bytes(part.bytes, language)}
            {typeof part.files === "number" && (
              <span className={classes.about}>{t("storage.files", { count: part.files })}</span>
            )}
          </div>
          <div className={classes.track} aria-hidden="true">
            <span className={classes.fill} style={{ width: `${(100 * part.bytes) / most}%` }} />
          </div>
        </li>
      ))}
    </ul>
  );
}
