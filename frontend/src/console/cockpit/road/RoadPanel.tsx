/** The road that the participant crosses: whether its scene runs, and how each crossing went. */
import { type Crossing, type RoadRun, roadRecordOf, type SessionRoad } from "@shared/api/road";
import type { SessionView } from "@shared/api/types";
import { decimals } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { sessionRoadQuery } from "../../queries";
import cockpit from "../Cockpit.module.css";
import panels from "../Panels.module.css";
import classes from "./RoadPanel.module.css";

/** Nothing is shown for a study without a road. */
export function RoadPanel({ session }: { readonly session: SessionView }): JSX.Element {
  const { t } = useTexts();
  const { data: road } = useQuery(sessionRoadQuery(session.id));
  if (road === undefined || !road.has_road) return <></>;
  const problem = problemNow(session, road);
  return (
    <section aria-label={t("road.title")}>
      <h2 className={cockpit.sectionTitle}>{t("road.title")}</h2>
      {road.missing !== "" && <Notice tone="bad" title={road.missing} />}
      {problem === null ? (
        <p className={classes.state} role="status">
          <Now now={road.now} />
        </p>
      ) : (
        <Notice tone="bad" title={t("road.problem")} remedy={t("road.problem.do")}>
          {problem}
        </Notice>
      )}
      {road.runs.length === 0 ? (
        <p className={panels.empty}>{t("road.empty")}</p>
      ) : (
        <Runs session={session} runs={road.runs} />
      )}
    </section>
  );
}

/** Why the scene of the phase that is in progress broke off; null if it did not. */
function problemNow(session: SessionView, { now, runs }: SessionRoad): string | null {
  const last = runs.at(-1);
  const phase = session.phases.find(({ phase_id }) => phase_id === last?.phase_id);
  const isPresent = phase !== undefined && phase.status !== "done" && phase.status !== "voided";
  if (!isPresent || (now !== null && !now.is_over)) return null;
  return now?.problem || last?.reason || null;
}

function Now({ now }: Pick<SessionRoad, "now">): JSX.Element {
  const { t } = useTexts();
  if (now === null) return <>{t("road.waits")}</>;
  const guessed = now.guesses > 0 ? ` · ${t("road.guesses", { count: now.guesses })}` : "";
  if (now.is_over) return <>{t("road.over") + guessed}</>;
  if (now.waits_for.length > 0) {
    return <>{t("road.unconnected", { programs: now.waits_for.join(", ") })}</>;
  }
  if (!now.is_heard) return <>{t("road.unheard") + guessed}</>;
  return <>{t("road.runs", { count: now.cars }) + guessed}</>;
}

interface RunsProps {
  readonly session: SessionView;
  readonly runs: readonly RoadRun[];
}

function Runs({ session, runs }: RunsProps): JSX.Element {
  return (
    <>
      {runs.map((run) => (
        <Run key={run.id} session={session} run={run} />
      ))}
    </>
  );
}

function Run({ session, run }: { readonly session: SessionView; readonly run: RoadRun }) {
  const { t } = useTexts();
  const phase = session.phases.find(({ phase_id }) => phase_id === run.phase_id);
  const block = phase === undefined ? null : (session.steps[phase.step_index]?.block ?? null);
  const attempt = phase?.attempt ?? 1;
  const name = [
    block === null ? t("road.phase", { number: run.phase_id }) : t("road.block", { number: block }),
    attempt > 1 ? t("timeline.attempt", { number: attempt }) : null,
    run.part > 1 ? t("road.part", { number: run.part }) : null,
    run.reason === "" ? null : t("road.brokeOff"),
  ];
  const done = run.crossings.filter(({ steps_on_s }) => steps_on_s !== null);
  const file = `road_${run.phase_id}_${run.part}.jsonl`;
  return (
    <div className={classes.run}>
      <div className={classes.name}>
        <h3>{name.filter((part) => part !== null).join(" · ")}</h3>
        <a href={roadRecordOf(session.id, run.id)} download={file} title={file}>
          {t("road.record")}
        </a>
      </div>
      {done.length > 0 && (
        <ol className={classes.crossings}>
          {done.map((one) => (
            <li key={one.number} aria-label={t("road.crossing", { number: one.number })}>
              <Measures one={one} />
            </li>
          ))}
        </ol>
      )}
      {done.length === 0 && run.ended !== "running" && (
        <p className={classes.none}>{t("road.noCrossing")}</p>
      )}
    </div>
  );
}

function Measures({ one }: { readonly one: Crossing }): JSX.Element {
  const { t, language } = useTexts();
  const shown = (value: number, unit: string) => `${decimals(value, language, 1)} ${unit}`;
  const { gap_accepted_s: gapS, closest_m: closestM } = one;
  const isTurned = one.steps_off_s !== null && !one.is_across;
  return (
    <>
      <dl className={`${classes.measures} numbers`}>
        <dt>{t("road.waited")}</dt>
        <dd>{shown(one.waited_s, "s")}</dd>
        <dt>{t("road.refused")}</dt>
        <dd>{one.gaps_refused_s.length}</dd>
        <dt>{t("road.gap")}</dt>
        <dd>{gapS === null ? t("road.none") : shown(gapS, "s")}</dd>
        <dt>{t("road.closest")}</dt>
        <dd>{closestM === null ? t("road.none") : shown(closestM, "m")}</dd>
      </dl>
      {isTurned && <p className={classes.none}>{t("road.turned")}</p>}
      {one.collision_car !== null && (
        <p className={classes.hit}>
          <Icon name="alert" size={14} />{" "}
          {t("road.collision", { speed: decimals(one.collision_speed_m_s ?? 0, language, 1) })}
        </p>
      )}
    </>
  );
}
