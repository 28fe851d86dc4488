/** In the place of figures that are being drawn: of which sessions, since when, and their outlines. */
import { Loader, Skeleton } from "@mantine/core";
import type { FigureGroup } from "@shared/api/analysis";
import type { DataKind } from "@shared/api/types";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useEffect, useState } from "react";
import { useTexts } from "../../i18n";
import { ledgerQuery } from "../../queries";
import classes from "./DashboardTab.module.css";

/** How many outlines stand for figures whose number is not known yet. */
const OUTLINES = { main: [1, 2, 3, 4], other: [1, 2] } as const;
/** From here on how long it has taken is worth saying, s. */
const SAID_FROM_S = 3;

interface BeingDrawnProps {
  readonly studyKey: string;
  readonly kind: DataKind;
  readonly group: FigureGroup;
  readonly isMain: boolean;
}

export function BeingDrawn({ studyKey, kind, group, isMain }: BeingDrawnProps): JSX.Element {
  const { t } = useTexts();
  const slots = useQuery(ledgerQuery(studyKey, kind)).data?.slots;
  const elapsedS = useSecondsSinceShown();
  const of = (state: "completed" | "open") =>
    slots?.filter((slot) => slot.state === state).length ?? 0;
  return (
    <div className={classes.beingDrawn}>
      <p className={`${classes.drawing} numbers`}>
        <Loader size={14} aria-hidden />
        <span role="status">
          {t("dashboard.drawing.group", { group: t(`figures.group.${group}`) })}{" "}
          {slots !== undefined &&
            t("dashboard.drawing.of", { completed: of("completed"), open: of("open") })}
        </span>
        {/* Not announced every second. */}
        <span aria-hidden="true">
          {elapsedS >= SAID_FROM_S && t("dashboard.drawing.since", { seconds: elapsedS })}
        </span>
      </p>
      <div
        className={isMain ? `${classes.figures} ${classes.main}` : classes.figures}
        aria-hidden="true"
      >
        {OUTLINES[isMain ? "main" : "other"].map((outline) => (
          <div
            key={outline}
            className={isMain ? `${classes.figure} ${classes.compact}` : classes.figure}
          >
            <Skeleton height={18} width="60%" mb={10} />
            <Skeleton className={isMain ? (classes.plot ?? "") : ""} height={isMain ? "" : 300} />
            <Skeleton height={14} width="40%" mt={10} />
          </div>
        ))}
      </div>
    </div>
  );
}

function useSecondsSinceShown(): number {
  const [elapsedS, setElapsedS] = useState(0);
  useEffect(() => {
    const timer = setInterval(() => setElapsedS((before) => before + 1), 1000);
    return () => clearInterval(timer);
  }, []);
  return elapsedS;
}
