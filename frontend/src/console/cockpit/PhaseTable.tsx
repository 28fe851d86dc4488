/** What was recorded in each phase, once the session is over. */
import type { PhaseSummary, SessionView } from "@shared/api/types";
import { latency, number } from "@shared/format";
import { milliseconds } from "@shared/units";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { AchievedLatency } from "./AchievedLatency";
import cockpit from "./Cockpit.module.css";
import classes from "./Panels.module.css";

const COLUMNS = [
  "phase",
  "latency",
  "achieved",
  "active",
  "completions",
  "contacts",
  "contactTime",
] as const;

export function PhaseTable({ session }: { readonly session: SessionView }): JSX.Element | null {
  const { t } = useTexts();
  const tasks = session.phases.filter((phase) => phase.limb !== null);
  if (tasks.length === 0) return null;
  return (
    <section className={classes.card}>
      <h2 className={cockpit.sectionTitle}>{t("recorded.title")}</h2>
      <table className={`${classes.table} numbers`}>
        <thead>
          <tr>
            {COLUMNS.map((column) => (
              <th key={column} scope="col">
                {t(`recorded.${column}`)}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {tasks.map((phase) => (
            <PhaseRow key={phase.phase_id} phase={phase} />
          ))}
        </tbody>
      </table>
    </section>
  );
}

function PhaseRow({ phase }: { readonly phase: PhaseSummary }): JSX.Element {
  const { t, language } = useTexts();
  const voided = phase.status === "voided";
  return (
    <tr className={voided ? classes.voided : undefined}>
      <td className={classes.phase}>
        {phase.limb !== null && (
          <span className={classes.nowrap}>{t(`step.task.${phase.limb}`)}</span>
        )}
        {phase.attempt > 1 && ` · ${t("timeline.attempt", { number: phase.attempt })}`}
        {voided && ` · ${t("recorded.voided")}`}
      </td>
      <td>
        {phase.latency_ms === null ? t("timeline.hidden") : latency(milliseconds(phase.latency_ms))}
      </td>
      <td>
        <AchievedLatency phase={phase} />
      </td>
      <td>{number(phase.active_s, language, 1)} s</td>
      <td>{phase.completions}</td>
      <td>{phase.side_contacts}</td>
      <td>{number(phase.side_contact_s, language, 1)} s</td>
    </tr>
  );
}
