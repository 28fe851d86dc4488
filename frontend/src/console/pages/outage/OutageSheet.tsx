import type { SessionView, Step } from "@shared/api/types";
import { dateTime, duration, latency } from "@shared/format";
import { inLanguage } from "@shared/text";
import { Icon } from "@shared/ui/Icon";
import { milliseconds, seconds } from "@shared/units";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { groupSteps } from "../../cockpit/record/Timeline";
import { type Key, useTexts } from "../../i18n";
import { sessionQuery } from "../../queries";
import { stepName } from "../../steps";
import { Loaded } from "../../ui/Loaded";
import { Order } from "../../ui/Order";
import { PaperPage } from "../../ui/PaperPage";
import { useTitle } from "../../ui/page";
import { ScrollBox } from "../../ui/tables";
import classes from "./OutageSheet.module.css";

export function OutageSheet({ id }: { readonly id: string }): JSX.Element {
  const { t } = useTexts();
  useTitle(t("outage.title"));
  return (
    <PaperPage sessionId={id} back={t("outage.back")} print={t("outage.print")}>
      <p className={classes.lead}>{t("outage.lead")}</p>
      <Loaded query={useQuery(sessionQuery(id))}>{(session) => <Sheet session={session} />}</Loaded>
    </PaperPage>
  );
}

/** What to do, in the order of the minutes. */
const ADVICE: readonly { readonly title: Key; readonly points: readonly Key[] }[] = [
  {
    title: "outage.first",
    points: ["outage.first.participant", "outage.first.devices", "outage.first.note"],
  },
  {
    title: "outage.restart",
    points: [
      "outage.restart.computer",
      "outage.restart.start",
      "outage.restart.open",
      "outage.restart.resume",
    ],
  },
  { title: "outage.stop", points: ["outage.stop.end", "outage.stop.later", "outage.stop.sick"] },
];

const FAILURE = ["at", "step", "back", "told", "by", "contact"] as const;

function Sheet({ session }: { readonly session: SessionView }): JSX.Element {
  const { t, language } = useTexts();
  const [now] = useState(() => new Date().toISOString());
  return (
    <article className={classes.sheet}>
      <header>
        <p className={classes.kicker}>
          {t("outage.made", {
            study: inLanguage(session.study_title, language),
            version: session.study_version,
            when: dateTime(now, language),
          })}
        </p>
        <h1>{t("outage.title")}</h1>
        <p className={classes.code}>
          <strong>{session.participant_code}</strong>
          {session.sequence !== null && (
            <span>
              {t("outage.order")}: <Order sequence={session.sequence} bodies={session.bodies} />
            </span>
          )}
        </p>
      </header>
      {ADVICE.map(({ title, points }, place) => (
        <section key={title} className={classes.advice}>
          <h2>
            {place + 1}. {t(title)}
          </h2>
          <ol>
            {points.map((point) => (
              <li key={point}>{t(point)}</li>
            ))}
          </ol>
        </section>
      ))}
      <p className={classes.address}>
        {t("outage.address")}: <code>{window.location.origin}</code>
      </p>
      <section>
        <h2>{t("outage.failure")}</h2>
        <dl className={classes.blanks}>
          {FAILURE.map((one) => (
            <div key={one}>
              <dt>{t(`outage.failure.${one}`)}</dt>
              <dd />
            </div>
          ))}
        </dl>
      </section>
      <Steps session={session} />
    </article>
  );
}

function Steps({ session }: { readonly session: SessionView }): JSX.Element {
  const { t } = useTexts();
  return (
    <section className={classes.steps}>
      <h2>{t("outage.steps")}</h2>
      <ScrollBox label={t("outage.steps")}>
        <table>
          <thead>
            <tr>
              <th scope="col">{t("outage.done")}</th>
              <th scope="col">{t("outage.step")}</th>
              <th scope="col">{t("outage.time")}</th>
              <th scope="col">{t("outage.note")}</th>
            </tr>
          </thead>
          {groupSteps(session.steps).map(({ block, number, latency: added, steps }) => (
            <tbody key={steps[0]?.index}>
              {block !== null && (
                <tr>
                  <th scope="rowgroup" colSpan={4}>
                    {t("outage.block", { number })}
                    {added !== null && ` · ${latency(milliseconds(added))}`}
                  </th>
                </tr>
              )}
              {steps.map((step) => (
                <Line key={step.index} step={step} />
              ))}
            </tbody>
          ))}
        </table>
      </ScrollBox>
    </section>
  );
}

function Line({ step }: { readonly step: Step }): JSX.Element {
  const { t } = useTexts();
  const isDone = step.status === "done" || step.status === "skipped";
  return (
    <tr>
      <td className={classes.box}>
        {isDone ? <Icon name="check" size={16} /> : <span aria-hidden="true" />}
        {isDone && <span className="visually-hidden">{t(`timeline.${step.status}`)}</span>}
      </td>
      <td>
        {step.index + 1}. {t(stepName(step))}
      </td>
      <td className="numbers">{step.duration_s !== null && duration(seconds(step.duration_s))}</td>
      <td className={classes.note} />
    </tr>
  );
}
