/** What takes how much room, and for how many more sessions there is some. */
import { Button, Paper, Text, Title } from "@mantine/core";
import { type StorageRoom, storageRoom } from "@shared/api/housekeeping";
import { timeOfDay } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { Copyable } from "../pages/network/Copyable";
import { storageQuery } from "../queries";
import { bytes } from "../ui/bytes";
import { Loaded } from "../ui/Loaded";
import { useTitle } from "../ui/useTitle";
import { DiskBar } from "./DiskBar";
import { LargestSessions } from "./LargestSessions";
import { Parts } from "./Parts";
import classes from "./Storage.module.css";
import { StudyRooms } from "./StudyRooms";

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
      <Loaded query={query}>{(room) => <Room room={room} />}</Loaded>
    </>
  );
}

function Room({ room }: { readonly room: StorageRoom }): JSX.Element {
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
          <Copyable text="reembody backup FILE" />
          <p className={classes.soft}>{t("storage.backup.docs")}</p>
        </Paper>
        <Paper className={classes.wide ?? ""}>
          <Title order={2}>{t("storage.studies")}</Title>
          <StudyRooms studies={room.studies} />
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
