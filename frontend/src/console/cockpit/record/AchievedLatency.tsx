/** The latency that a phase really had: with its uncertainty, and with a badge when it is off. */
import type { PhaseSummary } from "@shared/api/types";
import { latencyDifference, latencyMeasured, latencyWithin, number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import type { JSX, ReactNode } from "react";
import { type Key, useTexts } from "../../i18n";
import classes from "./AchievedLatency.module.css";
import { LEAST_MOVEMENT, verdictOn } from "./achieved";

interface AchievedLatencyProps {
  readonly phase: PhaseSummary;
}

export function AchievedLatency({ phase }: AchievedLatencyProps): JSX.Element {
  const { t, language } = useTexts();
  const verdict = verdictOn(phase);
  switch (verdict.kind) {
    case "none":
      return <span>–</span>;
    case "measuring":
      return <Soft>{t("achieved.measuring")}</Soft>;
    case "still":
      return (
        <Soft>
          {t("achieved.still")}
          <small className={classes.detail}>
            {t("achieved.moved", {
              // Cut off, not rounded: 4.97 s must not read as the 5 s that are enough.
              moved: number(Math.floor(verdict.movement * 10) / 10, language, 1),
              needed: LEAST_MOVEMENT,
            })}
          </small>
        </Soft>
      );
    case "unknown":
      return (
        <Soft>
          {t("achieved.unknown")}
          <Reason text={verdict.reason} />
        </Soft>
      );
    case "hidden":
      return verdict.off ? <Off text="achieved.out" /> : <span>{t("achieved.within")}</span>;
    case "measured":
      return (
        <>
          <span className={classes.measured}>
            <span className={classes.value}>
              {latencyWithin(verdict.value, verdict.halfWidth, language)}
            </span>
            {verdict.off && (
              <Off text="achieved.off" by={latencyDifference(verdict.by, language)} />
            )}
          </span>
          <Reason text={verdict.reason} />
        </>
      );
  }
}

/** The same in a few words for the list of steps; nothing where there is nothing to say yet. */
export function AchievedInBrief({ phase }: AchievedLatencyProps): JSX.Element | null {
  const { t, language } = useTexts();
  const verdict = verdictOn(phase);
  switch (verdict.kind) {
    case "none":
    case "measuring":
      return null;
    case "still":
    case "unknown":
      return <span>{t("achieved.unverified")}</span>;
    case "hidden":
      return verdict.off ? (
        <Off text="achieved.latencyOut" />
      ) : (
        <span>{t("achieved.latencyWithin")}</span>
      );
    case "measured": {
      // Beside a badge there is no room for the uncertainty; it is small against what is off.
      if (verdict.off)
        return <Off text="achieved.brief" by={latencyMeasured(verdict.value, language)} />;
      const value = latencyWithin(verdict.value, verdict.halfWidth, language);
      return <span className={classes.value}>{t("achieved.brief", { by: value })}</span>;
    }
  }
}

function Soft({ children }: { readonly children: ReactNode }): JSX.Element {
  return <span className={classes.soft}>{children}</span>;
}

function Off({ text, by = "" }: { readonly text: Key; readonly by?: string }): JSX.Element {
  const { t } = useTexts();
  return (
    <span className={classes.off}>
      <Icon name="alert" size={14} />
      {t(text, { by })}
    </span>
  );
}

/** The server speaks English, whatever the page does. */
function Reason({ text }: { readonly text: string | null }): JSX.Element | null {
  if (text === null) return null;
  return (
    <small lang="en" className={classes.detail}>
      {text}
    </small>
  );
}
