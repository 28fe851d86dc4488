/**
 * The achieved latency of a phase: with its uncertainty, and with a badge if it is out of
 * tolerance.
 */
import type { PhaseSummary } from "@shared/api/types";
import { latencyDifference, latencyMeasured, latencyWithin, number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { type Milliseconds, milliseconds, type Seconds, seconds } from "@shared/units";
import type { JSX, ReactNode } from "react";
import { type Key, useTexts } from "../../i18n";
import classes from "./AchievedLatency.module.css";

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
      return <MutedText>{t("achieved.measuring")}</MutedText>;
    case "still":
      return (
        <MutedText>
          {t("achieved.still")}
          <small className={classes.detail}>
            {t("achieved.moved", {
              // Truncated rather than rounded: 4.97 s must not read as the 5 s that are required.
              moved: number(Math.floor(verdict.movement * 10) / 10, language, 1),
              needed: MIN_MOVEMENT,
            })}
          </small>
        </MutedText>
      );
    case "unknown":
      return (
        <MutedText>
          {t("achieved.unknown")}
          <Reason text={verdict.reason} />
        </MutedText>
      );
    case "hidden":
      return verdict.off ? (
        <ToleranceBadge text="achieved.out" />
      ) : (
        <span>{t("achieved.within")}</span>
      );
    case "measured":
      return (
        <>
          <span className={classes.measured}>
            <span className={classes.value}>
              {latencyWithin(verdict.value, verdict.halfWidth, language)}
            </span>
            {verdict.off && (
              <ToleranceBadge text="achieved.off" by={latencyDifference(verdict.by, language)} />
            )}
          </span>
          <Reason text={verdict.reason} />
        </>
      );
  }
}

/** The same in a few words for the list of steps; empty while there is no result. */
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
        <ToleranceBadge text="achieved.latencyOut" />
      ) : (
        <span>{t("achieved.latencyWithin")}</span>
      );
    case "measured": {
      // Next to the badge there is no room for the uncertainty, which is small compared to the
      // deviation.
      if (verdict.off)
        return (
          <ToleranceBadge text="achieved.brief" by={latencyMeasured(verdict.value, language)} />
        );
      const value = latencyWithin(verdict.value, verdict.halfWidth, language);
      return <span className={classes.value}>{t("achieved.brief", { by: value })}</span>;
    }
  }
}

function MutedText({ children }: { readonly children: ReactNode }): JSX.Element {
  return <span className={classes.soft}>{children}</span>;
}

function ToleranceBadge({
  text,
  by = "",
}: {
  readonly text: Key;
  readonly by?: string;
}): JSX.Element {
  const { t } = useTexts();
  return (
    <span className={classes.off}>
      <Icon name="alert" size={14} />
      {t(text, { by })}
    </span>
  );
}

/** The reason from the server, which is always in English. */
function Reason({ text }: { readonly text: string | null }): JSX.Element | null {
  if (text === null) return null;
  return (
    <small lang="en" className={classes.detail}>
      {text}
    </small>
  );
}

// The verdicts on the achieved latency of a phase, compared with the set one.

/** With less movement than this the server gives no result (`LEAST_MOVEMENT_S` in its science). */
const MIN_MOVEMENT: Seconds = seconds(5);

type Verdict =
  /** The phase is not over, or was voided before it was measured. */
  | { readonly kind: "none" }
  /** The server is still computing it. */
  | { readonly kind: "measuring" }
  /** The participant hardly moved. */
  | { readonly kind: "still"; readonly movement: Seconds }
  /** It could not be measured; the reason is in the server's words. */
  | { readonly kind: "unknown"; readonly reason: string | null }
  /** A blinded operator is told only whether it is in tolerance. */
  | { readonly kind: "hidden"; readonly off: boolean }
  | {
      readonly kind: "measured";
      readonly value: Milliseconds;
      /** Half of the 95 % interval. */
      readonly halfWidth: Milliseconds;
      readonly off: boolean;
      /** Achieved minus set latency. */
      readonly by: Milliseconds;
      /** A caveat in the server's words. */
      readonly reason: string | null;
    };

export function verdictOn(phase: PhaseSummary): Verdict {
  if (phase.movement_s === null) return { kind: phase.status === "done" ? "measuring" : "none" };
  if (phase.latency_off === null)
    return phase.movement_s < MIN_MOVEMENT
      ? { kind: "still", movement: seconds(phase.movement_s) }
      : { kind: "unknown", reason: phase.latency_reason };
  const { achieved_latency_ms: value, achieved_low_ms: low, achieved_high_ms: high } = phase;
  if (value === null || low === null || high === null || phase.latency_ms === null)
    return { kind: "hidden", off: phase.latency_off };
  return {
    kind: "measured",
    value: milliseconds(value),
    halfWidth: milliseconds((high - low) / 2),
    off: phase.latency_off,
    by: milliseconds(value - phase.latency_ms),
    reason: phase.latency_reason,
  };
}
