/** The skeletons of a source, each of which can be watched on a body. */
import { Button } from "@mantine/core";
import type { Performer, Performers } from "@shared/api/performers";
import type { Source } from "@shared/api/trackers";
import { type JSX, useState } from "react";
import { useTexts } from "../i18n";
import classes from "./Performer.module.css";
import { titleOf, WatchPanel } from "./WatchPanel";

interface SkeletonListProps {
  readonly source: Source;
  readonly all: Performers;
}

export function SkeletonList({ source, all }: SkeletonListProps): JSX.Element {
  const { t } = useTexts();
  const own = all.performers.filter(
    (one) =>
      one.door === source.door && one.address === source.address && one.source === source.name,
  );
  if (own.length === 0) return <p className={classes.by}>{t("performer.noSkeleton")}</p>;
  return (
    <>
      {own.map((performer) => (
        <Skeleton key={performer.skeleton} performer={performer} all={all} />
      ))}
    </>
  );
}

interface SkeletonProps {
  readonly performer: Performer;
  readonly all: Performers;
}

function Skeleton({ performer, all }: SkeletonProps): JSX.Element {
  const { t } = useTexts();
  const [isShown, setShown] = useState(false);
  const name = titleOf(performer);
  const reason = reasonOf(performer);
  return (
    <>
      <div className={classes.skeleton}>
        <Button
          size="xs"
          variant={isShown ? "default" : "light"}
          aria-expanded={isShown}
          aria-label={t(isShown ? "performer.hideOf" : "performer.watchOf", { name })}
          onClick={() => setShown(!isShown)}
        >
          {t(isShown ? "performer.hide" : "performer.watch")}
        </Button>
        <span className={classes.by}>
          {[performer.skeleton, reason === null ? "" : t("performer.cannot", { reason })]
            .filter((part) => part !== "")
            .join(". ")}
        </span>
      </div>
      {isShown && (
        <WatchPanel performer={performer} recording={all.recordings.find(isOf(performer))} />
      )}
    </>
  );

  function reasonOf({ state, missing, problems }: Performer): string | null {
    if (state === "ready") return null;
    const listed = (state === "gathering" ? missing : problems).join(", ");
    return t(`performer.cannot.${state}`, { listed });
  }
}

const isOf =
  (performer: Performer) =>
  (one: Pick<Performer, "door" | "source" | "skeleton">): boolean =>
    one.door === performer.door &&
    one.source === performer.source &&
    one.skeleton === performer.skeleton;
