/** The lab at a glance: today's sessions, and those that somebody should look at. */
import { Title } from "@mantine/core";
import type { Attention, SessionBrief, LabState as State } from "@shared/api/housekeeping";
import { dateTime, timeOfDay } from "@shared/format";
import { inLanguage } from "@shared/text";
import type { JSX, ReactNode } from "react";
import { Link } from "wouter";
import { useTexts } from "../i18n";
import { KindBadge, StatusBadge } from "../ui/badges";
import classes from "./Home.module.css";

export function LabState({ state }: { readonly state: State }): JSX.Element {
  const { t, language } = useTexts();
  return (
    <div className={classes.state}>
      <Panel id="today" title={t("home.today")} none={t("home.today.none")}>
        {state.today.map((one) => (
          <Line
            key={one.session_id}
            session={one}
            at={t(sinceWhen(one), { time: timeOfDay(one.at, language) })}
          >
            <StatusBadge status={one.status} />
            {one.kind !== "people" && <KindBadge kind={one.kind} />}
          </Line>
        ))}
      </Panel>
      <Panel id="attention" title={t("home.attention")} none={t("home.attention.none")}>
        {state.attention.map((one: Attention) => (
          <Line
            key={`${one.session_id} ${one.concern}`}
            session={one}
            at={dateTime(one.at, language)}
          >
            <span className={classes.concern}>{t(`home.concern.${one.concern}`)}</span>
          </Line>
        ))}
      </Panel>
    </div>
  );
}

/** What the time of a session is of: the last change of its state. */
function sinceWhen({ status }: SessionBrief) {
  if (status === "planned") return "home.at.planned";
  return status === "active" ? "home.at.started" : "home.at.ended";
}

interface PanelProps {
  readonly id: string;
  readonly title: string;
  readonly none: string;
  readonly children: readonly ReactNode[];
}

function Panel({ id, title, none, children }: PanelProps): JSX.Element {
  return (
    <section className={classes.panel} aria-labelledby={`lab-${id}`}>
      <Title order={2} id={`lab-${id}`} className={classes.panelTitle ?? ""}>
        {title}
      </Title>
      {children.length === 0 ? <p className={classes.none}>{none}</p> : <ul>{children}</ul>}
    </section>
  );
}

interface LineProps {
  readonly session: SessionBrief;
  readonly at: string;
  readonly children: ReactNode;
}

function Line({ session, at, children }: LineProps): JSX.Element {
  const { language } = useTexts();
  return (
    <li className={classes.line}>
      <Link href={`/sessions/${session.session_id}`} title={session.participant_code}>
        {session.participant_code}
      </Link>
      <span className={classes.marks}>{children}</span>
      <span className={`${classes.when} numbers`} title={inLanguage(session.study_title, language)}>
        {at}
      </span>
    </li>
  );
}
