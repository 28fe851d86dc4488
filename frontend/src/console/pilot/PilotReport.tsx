/** What a pilot found: a cohort's figures, the power of the test, and texts for forms. */
import { Figure } from "@charts/Figure";
import { Paper, Title } from "@mantine/core";
import { decimals, measuredTime, number } from "@shared/format";
import { inLanguage, type Text } from "@shared/text";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { seconds } from "@shared/units";
import type { JSX, ReactNode } from "react";
import { useTexts } from "../i18n";
import { CopyButton } from "../pages/study/ResultCard";
import { NumbersTable } from "../ui/tables";
import { hasInterval, latencyFigure, peopleIn } from "./figures";
import { interval } from "./intervals";
import classes from "./Pilot.module.css";
import { PowerCard } from "./PowerCard";
import type { CohortFigures, Pilot } from "./pilots";

export function PilotReport({ pilot }: { readonly pilot: Pilot }): JSX.Element | null {
  const { t } = useTexts();
  if (pilot.state !== "ready") return null;
  const { figures, power, preregistration } = pilot;
  return (
    <>
      {figures !== null && <Cohort pilot={pilot} figures={figures} />}
      {power !== null && <PowerCard power={power} />}
      {figures !== null && <Paragraph title={t("pilot.ethics")} text={figures.ethics} />}
      {preregistration !== null && <Paragraph title={t("pilot.prereg")} text={preregistration} />}
    </>
  );
}

interface CohortProps {
  readonly pilot: Pilot;
  readonly figures: CohortFigures;
}

function Cohort({ pilot, figures }: CohortProps): JSX.Element {
  const { t, language } = useTexts();
  const limb = useLimbs();
  const people = pilot.participants[0] ?? 0;
  return (
    <>
      <Paper>
        <dl className={classes.facts}>
          <dt>{t("pilot.facts.length")}</dt>
          <dd>
            {t(
              Number(figures.walk_back_min.toFixed(1)) === 0
                ? "pilot.facts.length.noWalks"
                : "pilot.facts.length.value",
              {
                minutes: number(figures.session_min, language, 0),
                planned:
                  figures.planned_min == null ? "–" : number(figures.planned_min, language, 0),
                back: number(figures.walk_back_min, language, 1),
              },
            )}
          </dd>
          <dt>{t("pilot.facts.storage")}</dt>
          <dd>
            {t("pilot.facts.storage.value", { size: number(figures.storage_mb, language, 0) })}
          </dd>
          <dt>{t("pilot.facts.failures")}</dt>
          <dd>{t("pilot.facts.failures.value", { failures: figures.failures, people })}</dd>
          <dt>{t("pilot.facts.idle")}</dt>
          <dd>
            {figures.without_task.length === 0
              ? t("pilot.facts.idle.none")
              : figures.without_task
                  .map((one) => t("pilot.facts.idle.value", idleWords(one, limb, language)))
                  .join(", ")}
          </dd>
          <dt>{t("pilot.facts.avatar")}</dt>
          <dd>{t(`pilot.avatar.${figures.avatar}`)}</dd>
          {pilot.processor_s !== null && (
            <>
              <dt>{t("pilot.facts.time")}</dt>
              <dd>{measuredTime(seconds(pilot.processor_s), language)}</dd>
            </>
          )}
          <dt>{t("pilot.facts.hash")}</dt>
          <dd className={classes.hash}>{figures.sha256}</dd>
        </dl>
      </Paper>
      <Findings figures={figures} />
      <Phases figures={figures} />
      <Changes figures={figures} />
      <Reach figures={figures} />
    </>
  );
}

interface FiguresProps {
  readonly figures: CohortFigures;
}

function Findings({ figures }: FiguresProps): JSX.Element {
  const { t, language } = useTexts();
  const limb = useLimbs();
  const many = figures.without_task.filter(({ is_many }) => is_many);
  const remedy = t(
    figures.avatar === "delayed_copy"
      ? "pilot.findings.idle.remedy_copy"
      : "pilot.findings.idle.remedy_physics",
  );
  return (
    <Card title={t("pilot.findings")} note={t("pilot.findings.scope")}>
      {many.length > 0 && (
        <div className={classes.findings}>
          {many.map((one) => (
            <Notice
              key={`${one.limb} ${one.latency_ms}`}
              tone="warn"
              title={t("pilot.findings.idle", idleWords(one, limb, language))}
              remedy={remedy}
            >
              {t("pilot.findings.idle.words", idleWords(one, limb, language))}
            </Notice>
          ))}
        </div>
      )}
      {figures.problems.length === 0 ? (
        <p className={classes.fine}>
          <Icon name="check" size={18} /> {t("pilot.findings.none")}
        </p>
      ) : (
        <div className={classes.findings}>
          {figures.problems.map((one) => (
            <Notice
              key={one.path + one.kind}
              tone="warn"
              title={`${t(`pilot.kind.${one.kind}`)}: ${one.path}`}
              remedy={one.remedy}
            >
              {one.message}
            </Notice>
          ))}
        </div>
      )}
    </Card>
  );
}

/** Who completed no task, for a text: how many, with which limb, at which latency. */
const idleWords = (
  { limb, latency_ms, people, without }: CohortFigures["without_task"][number],
  limbOf: (limb: string) => string,
  language: string,
) => ({ without, people, limb: limbOf(limb), latency: number(latency_ms, language, 0) });

function Phases({ figures }: FiguresProps): JSX.Element {
  const texts = useTexts();
  const { t, language } = texts;
  const limb = useLimbs();
  const shown = (value: number, count = 1) => decimals(value, language, count);
  return (
    <Card title={t("pilot.phases")} note={t("pilot.phases.note")}>
      <NumbersTable
        className={classes.narrow}
        label={t("pilot.phases")}
        columns={[
          t("pilot.col.limb"),
          t("pilot.col.latency"),
          t("pilot.col.people"),
          t("pilot.col.tasks"),
          t("pilot.col.share"),
          t("pilot.col.sides"),
          t("pilot.col.red"),
          t("pilot.col.early"),
          t("pilot.col.back"),
          t("pilot.col.floor"),
        ]}
        rows={figures.phases.map((one) => [
          limb(one.limb),
          number(one.latency_ms, language, 0),
          String(one.people),
          `${shown(one.completions, 2)} (${shown(one.completions_sd, 2)})`,
          shareOf(texts, one),
          shown(one.side_contacts),
          shown(one.contact_time_s),
          shown(one.out_of_order, 2),
          shown(one.walk_back_s),
          shown(100 * one.at_floor, 0),
        ])}
      />
      {figures.phases.some((one) => one.share_of_lowest !== null) && (
        <>
          <h3 className={classes.small}>
            {t("pilot.phases.latency", { people: peopleIn(figures.phases) })}
          </h3>
          <Figure
            figure={latencyFigure(figures, {
              latency: t("pilot.axis.latency"),
              share: t("pilot.axis.share"),
              published: t("pilot.published"),
              limb,
              language,
            })}
            label={t("pilot.phases.latency", { people: peopleIn(figures.phases) })}
            watermark={t("simulated.watermark")}
            loading={t("dashboard.loading")}
            failed={t("dashboard.failed")}
          />
          <p className={classes.soft}>{t("pilot.phases.drawn")}</p>
        </>
      )}
      <p className={classes.soft}>
        {t(
          figures.avatar === "delayed_copy"
            ? "pilot.phases.limits"
            : "pilot.phases.limits.contacts",
        )}
      </p>
    </Card>
  );
}

/** Completions in per cent of those at the lowest latency, with the interval or why there is none. */
function shareOf(
  { t, language }: ReturnType<typeof useTexts>,
  phase: CohortFigures["phases"][number],
): string {
  const { share_of_lowest, share_low, share_high, people } = phase;
  if (share_of_lowest === null) return "–";
  const percent = (share: number) => decimals(100 * share, language, 0);
  const mean = percent(share_of_lowest);
  if (people === 1) return `${mean} (${t("pilot.noInterval.one")})`;
  // Pilots of earlier releases have none.
  if (share_low == null || share_high == null) return mean;
  return hasInterval(phase)
    ? `${mean} ${interval(percent(share_low), percent(share_high), language)}`
    : `${mean} (${t("pilot.noInterval.alike")})`;
}

function Changes({ figures }: FiguresProps): JSX.Element | null {
  const { t, language } = useTexts();
  const limb = useLimbs();
  if (figures.changes.length === 0) return null;
  const shown = (value: number) => decimals(value, language, 2);
  return (
    <Card title={t("pilot.changes")} note={t("pilot.changes.note")}>
      <NumbersTable
        label={t("pilot.changes")}
        columns={[
          t("pilot.col.limb"),
          t("pilot.col.measure"),
          t("pilot.col.change"),
          t("pilot.col.n"),
        ]}
        rows={figures.changes.map((one) => [
          limb(one.limb),
          t(`pilot.measure.${one.measure}`),
          one.low < one.high
            ? `${shown(one.mean)} ${interval(shown(one.low), shown(one.high), language)}`
            : `${shown(one.mean)} (${t("pilot.noInterval.alike")})`,
          String(one.people),
        ])}
      />
    </Card>
  );
}

function Reach({ figures }: FiguresProps): JSX.Element {
  const { t, language } = useTexts();
  const limb = useLimbs();
  return (
    <Card title={t("pilot.reach")} note={t("pilot.reach.note")}>
      <NumbersTable
        label={t("pilot.reach")}
        columns={[
          t("pilot.col.limb"),
          t("pilot.col.hand"),
          t("pilot.col.stature"),
          t("pilot.col.latency"),
          t("pilot.col.first"),
        ]}
        rows={figures.reach.map((one) => [
          limb(one.limb),
          t(one.hand === "left" ? "pilot.hand.left" : "pilot.hand.right"),
          decimals(one.stature_m, language, 3),
          number(one.latency_ms, language, 0),
          one.completion_s === null
            ? t("pilot.reach.out", { which: one.out_of_reach.join(", ") })
            : decimals(one.completion_s, language, 1),
        ])}
      />
    </Card>
  );
}

/** A text for a form in the language of the page, with a button that copies it. */
function Paragraph({ title, text }: { readonly title: string; readonly text: Text }): JSX.Element {
  const { t, language } = useTexts();
  // Pilots of earlier releases have it in English only.
  const shown = text[language] === undefined ? "en" : language;
  return (
    <Paper>
      <div className={classes.head}>
        <Title order={3}>{title}</Title>
        <CopyButton text={inLanguage(text, shown)} label={t("action.copy")} />
      </div>
      <p className={classes.paragraph} lang={shown}>
        {inLanguage(text, shown)}
      </p>
    </Paper>
  );
}

interface CardProps {
  readonly title: string;
  readonly note?: string;
  readonly children: ReactNode;
}

export function Card({ title, note, children }: CardProps): JSX.Element {
  return (
    <Paper>
      <Title order={3}>{title}</Title>
      {note !== undefined && <p className={classes.soft}>{note}</p>}
      {children}
    </Paper>
  );
}

function useLimbs(): (limb: string) => string {
  const { t } = useTexts();
  return (limb) => t(limb === "foot" ? "pilot.limb.foot" : "pilot.limb.hand");
}
