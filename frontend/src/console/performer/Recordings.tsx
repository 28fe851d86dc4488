/** Recordings that go on or are not stored yet, and those that were stored just now. */
import { Button } from "@mantine/core";
import { performers, type Recording, type RecordingStored } from "@shared/api/performers";
import { dateTime, decimals, duration, number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { seconds } from "@shared/units";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Link } from "wouter";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { actorName } from "../pages/people/auditWords";
import { usePermissions } from "../permissions";
import { performersQuery } from "../queries";
import classes from "./Performer.module.css";
import { titleOf } from "./WatchPanel";

/** Gaps that are listed; the rest are counted. */
const LISTED = 5;

interface Stored extends RecordingStored {
  readonly title: string;
}

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
  const store = useMutation({
    mutationFn: () => performers.store(recording.id),
    onSuccess: (result) => {
      onStored({ ...result, title: titleOf(recording) });
      void queries.invalidateQueries({ queryKey: ["captures"] });
    },
    onSettled: renew,
  });
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
          <Button
            size="xs"
            loading={store.isPending}
            disabled={recording.frames === 0}
            onClick={() => store.mutate()}
          >
            {t(isRunning ? "performer.stop" : "performer.store")}
          </Button>
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

interface StoredNoticeProps {
  readonly stored: Stored;
  readonly onClose: () => void;
}

/** What was stored, with its gaps. */
function StoredNotice({ stored, onClose }: StoredNoticeProps): JSX.Element {
  const { t, language } = useTexts();
  const at = (time: number): string => decimals(time, language, 2);
  const listed = stored.gaps
    .slice(0, LISTED)
    .map(({ from_s, to_s }) => t("performer.gap", { from: at(from_s), to: at(to_s) }));
  return (
    <Notice
      tone="info"
      icon="check"
      title={t("performer.stored", { name: stored.title })}
      actions={
        <>
          <Link href={`/captures/${stored.capture_id}`} className={classes.link ?? ""}>
            {t("performer.stored.open")} <Icon name="forward" size={14} />
          </Link>{" "}
          <Button size="compact-xs" variant="default" onClick={onClose}>
            {t("performer.stored.close")}
          </Button>
        </>
      }
    >
      {t("performer.stored.so", {
        time: at(stored.duration_s),
        rate: decimals(stored.rate_hz, language, 1),
        frames: number(stored.frames, language, 0),
      })}{" "}
      {stored.gaps.length === 0
        ? t("performer.stored.noGaps")
        : t("performer.stored.gaps", { count: stored.gaps.length, listed: listed.join(", ") })}{" "}
      {stored.held_share > 0 &&
        t("performer.stored.held", { value: decimals(100 * stored.held_share, language, 1) })}
    </Notice>
  );
}
