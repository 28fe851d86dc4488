/** The road that the participant crosses: whether its scene runs, and how each crossing went. */
import { type RoadRun, roadRecordOf, type SessionRoad } from "@shared/api/road";
import type { SessionView } from "@shared/api/types";
import { decimals } from "@shared/format";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { sessionRoadQuery } from "../../queries";
import { ScrollBox } from "../../ui/tables";
import cockpit from "../Cockpit.module.css";
import classes from "./RoadPanel.module.css";

/** Nothing is shown for a study without a road. */
export function RoadPanel({ session }: { readonly session: SessionView }): JSX.Element {
  const { t } = useTexts();
  const { data: road } = useQuery(sessionRoadQuery(session.id));
  if (road === undefined || !road.has_road) return <></>;
  const broken = road.now?.problem || (road.runs.at(-1)?.reason ?? "");
  return (
    <section aria-label={t("road.title")}>
      <h2 className={cockpit.sectionTitle}>{t("road.title")}</h2>
      {road.missing !== "" && <Notice tone="bad" title={road.missing} />}
      {broken !== "" && (
        <Notice tone="bad" title={t("road.problem", { problem: broken })}>
          {t("road.problem.do")}
        </Notice>
      )}
      <p className={classes.state} role="status">
        <Now now={road.now} />
      </p>
      <Crossings runs={road.runs} />
      <p className={classes.records}>
        {road.runs.map(({ id, phase_id, part }) => (
          <a
            key={id}
            href={roadRecordOf(session.id, id)}
            download={`road_${phase_id}_${part}.jsonl`}
          >
            {`${t("road.record")} ${phase_id}.${part}`}
          </a>
        ))}
      </p>
    </section>
  );
}

function Now({ now }: Pick<SessionRoad, "now">): JSX.Element {
  const { t } = useTexts();
  if (now === null) return <>{t("road.waits")}</>;
  const guessed = now.guesses > 0 ? ` · ${t("road.guesses")}: ${now.guesses}` : "";
  if (now.is_over) return <>{t("road.over") + guessed}</>;
  if (!now.is_heard) return <>{t("road.unheard")}</>;
  return <>{t("road.runs", { cars: now.cars }) + guessed}</>;
}

function Crossings({ runs }: { readonly runs: readonly RoadRun[] }): JSX.Element | null {
  const { t, language } = useTexts();
  const rows = runs.flatMap((run) => run.crossings.map((one) => ({ run: run.id, ...one })));
  const done = rows.filter((one) => one.steps_on_s !== null);
  if (done.length === 0) return null;
  const seconds = (value: number) => `${decimals(value, language, 1)} s`;
  return (
    <ScrollBox label={t("road.title")}>
      <table className={`${classes.table} numbers`}>
        <thead>
          <tr>
            <th scope="col">{t("road.crossing")}</th>
            <th scope="col">{t("road.waited")}</th>
            <th scope="col">{t("road.gap")}</th>
            <th scope="col">{t("road.refused")}</th>
            <th scope="col">{t("road.closest")}</th>
          </tr>
        </thead>
        <tbody>
          {done.map((one) => (
            <tr key={`${one.run}.${one.number}`}>
              <th scope="row">
                {`${one.phase_id}.${one.number}`}
                {one.steps_off_s !== null && !one.is_across && ` (${t("road.turned")})`}
              </th>
              <td>{seconds(one.waited_s)}</td>
              <td>{one.gap_accepted_s === null ? t("road.none") : seconds(one.gap_accepted_s)}</td>
              <td>{one.gaps_refused_s.length}</td>
              <td className={one.collision_car === null ? undefined : classes.hit}>
                {one.collision_car !== null
                  ? t("road.collision", {
                      speed: decimals(one.collision_speed_m_s ?? 0, language, 1),
                    })
                  : one.closest_m === null
                    ? "–"
                    : `${decimals(one.closest_m, language, 1)} m`}
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </ScrollBox>
  );
}
