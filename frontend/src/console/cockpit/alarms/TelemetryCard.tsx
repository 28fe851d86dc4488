/** What the headset reports right now. */

import type { SessionView } from "@shared/api/types";
import { number } from "@shared/format";
import { isCrossing } from "@shared/session/steps";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import cockpit from "../Cockpit.module.css";
import { FULL_SCALE_DEG } from "../live3d/heat";
import classes from "../Panels.module.css";
import { type TelemetryStore, useTelemetry } from "../session/telemetryStore";

interface TelemetryCardProps {
  readonly session: SessionView;
  readonly store: TelemetryStore;
}

export function TelemetryCard({ session, store }: TelemetryCardProps): JSX.Element | null {
  const { t, language } = useTexts();
  const received = useTelemetry(store);
  const phase = session.phases.at(-1);
  if (session.status !== "active") return null;
  const telemetry = received?.telemetry;
  const completions = telemetry?.completions ?? phase?.completions ?? null;
  // There are no boxes on a road, whose sides could be touched.
  const isRoad = session.steps.some((step) => step.index === phase?.step_index && isCrossing(step));
  const figures = isRoad
    ? ([["crossings", completions, ""]] as const)
    : ([
        ["completions", completions, ""],
        ["contacts", telemetry?.side_contacts ?? phase?.side_contacts ?? null, ""],
        ["contactTime", telemetry?.side_contact_s ?? phase?.side_contact_s ?? null, "s"],
      ] as const);
  if (telemetry === undefined && phase === undefined) return null;
  return (
    <section className={classes.card}>
      <h2 className={cockpit.sectionTitle}>
        <Icon name="chart" size={16} />
        {t("live.title")}
      </h2>
      <dl className={`${classes.figures} numbers`}>
        {figures.map(([name, value, unit]) => (
          <div key={name}>
            <dt>{t(`live.${name}`)}</dt>
            <dd>
              {value === null ? "–" : number(value, language, unit === "" ? 0 : 1)}
              {value !== null && unit !== "" && <span className={classes.unit}> {unit}</span>}
            </dd>
          </div>
        ))}
      </dl>
      {telemetry?.joint_error_deg !== undefined && (
        <JointErrors errors={telemetry.joint_error_deg} />
      )}
    </section>
  );
}

function JointErrors({ errors }: { readonly errors: Readonly<Record<string, number | null>> }) {
  const { t, language } = useTexts();
  return (
    <ul className={`${classes.errors} numbers`} aria-label={t("live.jointError")}>
      {Object.entries(errors).map(([joint, error]) => (
        <li key={joint} className={classes.error}>
          <span>{joint.replace(/([a-z])([A-Z])/g, "$1 $2")}</span>
          <span className={classes.errorTrack}>
            <span
              className={classes.errorBar}
              style={{
                display: "block",
                width: `${Math.min(1, (error ?? 0) / FULL_SCALE_DEG) * 100}%`,
              }}
            />
          </span>
          <span className={classes.errorValue}>
            {error === null ? "–" : `${number(error, language, 0)}°`}
          </span>
        </li>
      ))}
    </ul>
  );
}
