/** Recordings that go on or are not stored yet, and those that were stored just now. */
import { Button } from "@mantine/core";
import { performers, type Recording } from "@shared/api/performers";
import { dateTime, duration, number } from "@shared/format";
import { seconds } from "@shared/units";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { actorName } from "../pages/people/auditWords";
import { usePermissions } from "../permissions";
import { performersQuery } from "../queries";
import classes from "./Performer.module.css";
import { StoreButton, type Stored, StoredNotice, useStoring } from "./Storing";
import { titleOf } from "./WatchPanel";

export function Recordings({ all }: { readonly all: readonly Recording[] }): JSX.Element | null {
  const { t } = useTexts();
  const [stored, setStored] = useState<readonly Stored[]>([]);
  if (all.length === 0 && stored.length === 0) return null;
  return (
    <section className={classes.recordings} aria-label={t("performer.recordings")}>
      {all.map((one) => (
        <Going
          key={one.id}
          recording={one}
          onStored={(result) => setStored((before) => [...before, result])}
        />
      ))}
      {stored.map((one) => (
        <StoredNotice
          key={one.capture_id}
          stored={one}
          onClose={() => setStored((before) => before.filter((other) => other !== one))}
        />
      ))}
    </section>
  );
}

interface GoingProps {
  readonly recording: Recording;
  readonly onStored: (stored: Stored) => void;
}

function Going({ recording, onStored }: GoingProps): JSX.Element {
  const { t, language } = useTexts();
  const queries = useQueryClient();
  const canRecord = usePermissions()("recordPerformer");
  const renew = () => queries.invalidateQueries({ queryKey: performersQuery.queryKey });
  const store = useStoring(titleOf(recording), onStored);
  const discard = useMutation({
    mutationFn: () => performers.discard(recording.id),
    onSettled: renew,
  });
  const isRunning = recording.state === "running";
  const failed = store.error ?? discard.error;
  return (
    <div className={classes.going}>
      <span className={`${classes.dot} ${isRunning ? classes.running : ""}`} aria-hidden />
      <div>
        <strong>{t(`performer.recording.${recording.state}`, { name: titleOf(recording) })}</strong>
        <p className={`${classes.by} numbers`}>
          {t("performer.recording.so", {
            time: duration(seconds(recording.duration_s)),
            limit: duration(seconds(recording.limit_s)),
            frames: number(recording.frames, language, 0),
            by: actorName(recording.by),
            at: dateTime(recording.since, language),
          })}{" "}
          {t("performer.recording.memory")}
        </p>
        {failed !== null && <Failure error={failed} />}
      </div>
      {canRecord && (
        <div className={classes.actions}>
          <StoreButton recording={recording} store={store} />
          <Button
            size="xs"
            variant="default"
            disabled={store.isPending}
            loading={discard.isPending}
            onClick={() => discard.mutate()}
          >
            {t("performer.discard")}
          </Button>
        </div>
      )}
    </div>
  );
}
