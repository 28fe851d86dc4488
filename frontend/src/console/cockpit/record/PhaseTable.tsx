/** What was recorded in each phase, once the session is over. */

import { ActionIcon, Button } from "@mantine/core";
import type { PhaseSummary, SessionView } from "@shared/api/types";
import { latency, number } from "@shared/format";
import { isCrossing } from "@shared/session/steps";
import { Icon } from "@shared/ui/Icon";
import { milliseconds } from "@shared/units";
import type { JSX } from "react";
import { SessionDownload } from "../../downloads/DownloadsButton";
import { useTexts } from "../../i18n";
import { isCounted, stepName } from "../../steps";
import { ScrollBox } from "../../ui/tables";
import cockpit from "../Cockpit.module.css";
import classes from "../Panels.module.css";
import { AchievedLatency } from "./AchievedLatency";

const COLUMNS = ["phase", "latency", "achieved", "active", "completions"] as const;
/** What only tasks at boxes have. */
const AT_BOXES = ["contacts", "contactTime"] as const;

/** The replay's address contains a question mark, which the router would interpret as its own. */
const replayOf = (session: string, phase: number): string =>
  `#/sessions/${encodeURIComponent(session)}/replay?phase=${phase}`;

export function PhaseTable({ session }: { readonly session: SessionView }): JSX.Element | null {
  const { t } = useTexts();
  const tasks = session.phases.filter((phase) => phase.limb !== null || isCounted(phase));
  if (tasks.length === 0) return null;
  const hasBoxes = tasks.some((phase) => !isCrossing(phase));
  return (
    <section className={classes.card}>
      <div className={classes.titleRow}>
        <h2 className={cockpit.sectionTitle}>{t("recorded.title")}</h2>
        <SessionDownload session={session} />
        <Button
          component="a"
          href={`#/sessions/${encodeURIComponent(session.id)}/replay`}
          data-tour="replay"
          variant="subtle"
          size="compact-sm"
          leftSection={<Icon name="play" size={15} />}
        >
          {t("replay.open")}
        </Button>
      </div>
      <ScrollBox label={t("recorded.title")}>
        <table className={`${classes.table} ${classes.recorded} numbers`}>
          <thead>
            <tr>
              {[...COLUMNS, ...(hasBoxes ? AT_BOXES : [])].map((column) => (
                <th key={column} scope="col">
                  {t(`recorded.${column}`)}
                </th>
              ))}
              <th scope="col">
                <span className="visually-hidden">{t("replay.open")}</span>
              </th>
            </tr>
          </thead>
          <tbody>
            {tasks.map((phase) => (
              <PhaseRow
                key={phase.phase_id}
                session={session.id}
                phase={phase}
                hasBoxes={hasBoxes}
              />
            ))}
          </tbody>
        </table>
      </ScrollBox>
    </section>
  );
}

interface PhaseRowProps {
  readonly session: string;
  readonly phase: PhaseSummary;
}

function PhaseRow({
  session,
  phase,
  hasBoxes,
}: PhaseRowProps & { readonly hasBoxes: boolean }): JSX.Element {
  const { t, language } = useTexts();
  const isRoad = isCrossing(phase);
  const voided = phase.status === "voided";
  return (
    <tr className={voided ? classes.voided : undefined}>
      <td className={classes.phase}>
        <span className={classes.nowrap}>{t(stepName(phase))}</span>
        {phase.attempt > 1 && ` · ${t("timeline.attempt", { number: phase.attempt })}`}
        {voided && ` · ${t("recorded.voided")}`}
      </td>
      <td>
        {phase.latency_ms === null ? t("timeline.hidden") : latency(milliseconds(phase.latency_ms))}
        {phase.body !== null && ` · ${phase.body}`}
      </td>
      <td>
        <AchievedLatency phase={phase} />
      </td>
      <td>{phase.active_s === null ? "–" : `${number(phase.active_s, language, 1)} s`}</td>
      <td>{phase.completions ?? "–"}</td>
      {hasBoxes && (
        <>
          <td>{isRoad ? "–" : (phase.side_contacts ?? "–")}</td>
          <td>
            {isRoad || phase.side_contact_s === null
              ? "–"
              : `${number(phase.side_contact_s, language, 1)} s`}
          </td>
        </>
      )}
      <td>
        <ReplayLink session={session} phase={phase} />
      </td>
    </tr>
  );
}

function ReplayLink({ session, phase }: PhaseRowProps): JSX.Element {
  const { t } = useTexts();
  const name = t(stepName(phase));
  return (
    <ActionIcon
      component="a"
      href={replayOf(session, phase.phase_id)}
      variant="subtle"
      size="sm"
      aria-label={t("replay.open.phase", { phase: name })}
    >
      <Icon name="play" size={15} />
    </ActionIcon>
  );
}
