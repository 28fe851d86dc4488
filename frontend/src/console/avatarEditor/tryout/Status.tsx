/** How the simulation fares: its time and pace, and what went wrong. */
import { useInterval } from "@mantine/hooks";
import { decimals } from "@shared/format";
import { Notice } from "@shared/ui/Notice";
import { type JSX, useState } from "react";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import type { TryoutRun } from "./run";
import classes from "./Tryout.module.css";
import { useFigures } from "./useFigures";
import { useRunState } from "./useRunState";
import type { LiveTryout } from "./useTryout";

export function Problems({
  live,
  error,
}: {
  readonly live: LiveTryout;
  readonly error: unknown;
}): JSX.Element {
  const { t } = useTexts();
  const { error: unloaded } = live;
  const state = useRunState(live.run);
  const [failures, setFailures] = useState({ restored: 0, areFinite: true });
  useInterval(
    () => {
      const now = live.run?.progress ?? [];
      const restored = now.reduce((sum, one) => sum + one.restored + one.resets, 0);
      const areFinite = now.every((one) => one.isFinite);
      setFailures((before) =>
        before.restored === restored && before.areFinite === areFinite
          ? before
          : { restored, areFinite },
      );
    },
    500,
    { autoInvoke: true },
  );
  return (
    <>
      {error !== null && <Failure error={error} />}
      {unloaded !== null && (
        <Notice
          tone="bad"
          title={t("tryout.failed")}
          remedy={`${unloaded.message} ${t("tryout.failed.remedy")}`}
        />
      )}
      {state?.problem != null && (
        <Notice
          tone={state.phase === "failed" ? "bad" : "warn"}
          title={
            state.phase === "failed"
              ? t("tryout.stopped", { problem: state.problem })
              : state.problem
          }
          {...(state.phase === "failed" ? { remedy: t("tryout.failed.remedy") } : {})}
        />
      )}
      {!failures.areFinite && (
        <Notice tone="bad" title={t("tryout.notFinite")} remedy={t("tryout.notFinite.remedy")} />
      )}
      {failures.restored > 0 && (
        <Notice
          tone="warn"
          title={t("tryout.restored", { count: failures.restored })}
          remedy={t("tryout.restored.remedy")}
        />
      )}
    </>
  );
}

export function Speed({ run }: { readonly run: TryoutRun | null }): JSX.Element {
  const { t, language } = useTexts();
  const words = useFigures(
    run,
    ({ realTimeFactor, pace, timeS, state }) => {
      const time = t("tryout.time", { time: decimals(timeS, language, 1) });
      if (state.isPlaying && pace !== null && pace < KEEPS_UP) {
        return `${time} · ${t("tryout.slow", { pace: decimals(pace, language, 1) })}`;
      }
      if (realTimeFactor === null) return time;
      const factor = decimals(realTimeFactor, language, 1);
      return `${time} · ${t("tryout.speed", { factor })}`;
    },
    "",
  );
  return <span className={classes.speed}>{words}</span>;
}

/** Real time, as far as anybody sees. */
const KEEPS_UP = 0.95;
