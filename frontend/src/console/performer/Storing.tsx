/** Storing a recording as a capture, and what was stored, with its gaps. */
import { Button } from "@mantine/core";
import { performers, type Recording, type RecordingStored } from "@shared/api/performers";
import { decimals, number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link } from "wouter";
import { useTexts } from "../i18n";
import { performersQuery } from "../queries";
import classes from "./Performer.module.css";

/** Gaps that are listed; the rest are counted. */
const LISTED = 5;

export interface Stored extends RecordingStored {
  readonly title: string;
}

/** End a recording if it goes on, and store it; `title` is the performer's. */
export function useStoring(title: string, onStored: (stored: Stored) => void) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: ({ id }: Pick<Recording, "id">) => performers.store(id),
    onSuccess: (result) => {
      onStored({ ...result, title });
      void queries.invalidateQueries({ queryKey: ["captures"] });
    },
    onSettled: () => queries.invalidateQueries({ queryKey: performersQuery.queryKey }),
  });
}

interface StoredNoticeProps {
  readonly stored: Stored;
  readonly onClose: () => void;
}

export function StoredNotice({ stored, onClose }: StoredNoticeProps): JSX.Element {
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

/** Ends a recording that still runs, and stores it. */
export function StoreButton({
  recording,
  store,
}: {
  readonly recording: Recording;
  readonly store: ReturnType<typeof useStoring>;
}): JSX.Element {
  const { t } = useTexts();
  return (
    <Button
      size="xs"
      loading={store.isPending}
      disabled={recording.frames === 0}
      onClick={() => store.mutate(recording)}
    >
      {t(recording.state === "running" ? "performer.stop" : "performer.store")}
    </Button>
  );
}
