/** The list of checks in the cockpit: in the middle before the start, afterwards in a drawer. */
import { Button } from "@mantine/core";
import type { Check, SessionView } from "@shared/api/types";
import { timeOfDay } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { type JSX, useState } from "react";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { CheckList, RunningChecks } from "./CheckList";
import { failing } from "./checkTexts";
import { OverrideDialog } from "./OverrideDialog";
import classes from "./Preflight.module.css";
import type { Flight } from "./usePreflight";

interface PreflightCardProps {
  readonly session: SessionView;
  readonly flight: Flight;
}

interface PreflightBodyProps extends PreflightCardProps {
  /** The title, unless the surrounding element shows it. */
  readonly title?: string;
}

export function PreflightCard({ session, flight }: PreflightCardProps): JSX.Element {
  const { t } = useTexts();
  return (
    <section className={classes.card} aria-label={t("preflight.title")}>
      <PreflightBody session={session} flight={flight} title={t("preflight.title")} />
    </section>
  );
}

export function PreflightBody({ session, flight, title }: PreflightBodyProps): JSX.Element {
  const { t, language } = useTexts();
  const [overriding, setOverriding] = useState<Check | null>(null);
  const { data, error, isFetching, refetch } = flight.query;
  return (
    <>
      <div className={classes.head}>
        {title !== undefined && <h2 className={classes.title}>{title}</h2>}
        <span className={`${classes.at} numbers`}>
          {data !== undefined && t("preflight.at", { time: timeOfDay(data.at, language) })}
        </span>
        <Button
          size="xs"
          variant="default"
          leftSection={<Icon name="redo" size={15} />}
          disabled={isFetching}
          onClick={() => void refetch()}
        >
          {t("preflight.again")}
        </Button>
      </div>
      {data === undefined && error === null && (
        <>
          <p className={classes.summary} role="status">
            {t("preflight.loading")}
          </p>
          <RunningChecks />
        </>
      )}
      {error !== null && <Failure error={error} onRetry={() => void refetch()} />}
      {data !== undefined && (
        <>
          <Summary checks={data.checks} needsReason={data.asks} />
          <CheckList checks={data.checks} onOverride={data.asks ? setOverriding : undefined} />
        </>
      )}
      <OverrideDialog
        session={session}
        checks={overriding === null ? null : [overriding]}
        onClose={() => setOverriding(null)}
      />
    </>
  );
}

function Summary({
  checks,
  needsReason,
}: {
  readonly checks: readonly Check[];
  readonly needsReason: boolean;
}) {
  const { t } = useTexts();
  const failed = failing(checks).length;
  const waiting = checks.filter(({ status }) => status === "wait").length;
  const overridden = checks.filter(({ status }) => status === "overridden").length;
  const parts = [
    ...(failed > 0 ? [t("preflight.failed", { count: failed })] : []),
    ...(overridden > 0 ? [t("preflight.overridden", { count: overridden })] : []),
    ...(failed + overridden === 0 ? [t("preflight.clear")] : []),
    ...(waiting > 0 ? [t("preflight.waiting", { count: waiting })] : []),
    ...(needsReason ? [] : [t("preflight.harmless")]),
  ];
  return (
    <p className={classes.summary} role="status">
      {parts.join(" ")}
    </p>
  );
}
