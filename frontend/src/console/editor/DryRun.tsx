/** A dry run of one participant's session: every step with its time, for any slot. */
import { NumberInput, SegmentedControl } from "@mantine/core";
import { drafts, type Timeline, type TimelineStep } from "@shared/api/drafts";
import { clockFace, latency, number } from "@shared/format";
import { LANGUAGE_NAMES } from "@shared/i18n/i18n";
import { Prose } from "@shared/prose/Prose";
import { withoutMarks } from "@shared/text";
import { Notice } from "@shared/ui/Notice";
import { milliseconds, seconds } from "@shared/units";
import { keepPreviousData, useQuery } from "@tanstack/react-query";
import { type CSSProperties, type JSX, useState } from "react";
import { changeWords } from "../avatarChanges/words";
import { useTexts } from "../i18n";
import { useWalksBack } from "../pilot/walksBack";
import { Loaded } from "../ui/Loaded";
import { Order } from "../ui/Order";
import { ScrollBox } from "../ui/tables";
import classes from "./DryRun.module.css";
import type { Draft } from "./useDraft";

interface DryRunProps {
  readonly draft: Draft;
  /** The study that gets a new version; null for a new study, of which there is no pilot. */
  readonly studyKey: string | null;
}

export function DryRun({ draft, studyKey }: DryRunProps): JSX.Element {
  const { t, language } = useTexts();
  const walksBackMin = useWalksBack(studyKey, draft.check?.content_hash ?? null);
  const [slot, setSlot] = useState(0);
  const [chosenLanguage, setChosenLanguage] = useState<string>(language);
  const usable = draft.upToDate && draft.check?.ok === true;
  const query = useQuery({
    queryKey: ["timeline", draft.text, slot, chosenLanguage],
    queryFn: () => drafts.timeline(draft.text, slot, chosenLanguage),
    enabled: usable,
    placeholderData: keepPreviousData,
    gcTime: 30_000,
  });
  if (!usable && draft.problems.length > 0) {
    return (
      <Notice tone="warn" title={t("dryRun.broken")}>
        {t("dryRun.broken.body")}
      </Notice>
    );
  }
  return (
    <Loaded query={query}>
      {(timeline) => (
        <>
          <div className={classes.choice}>
            <NumberInput
              label={t("dryRun.slot")}
              description={t("dryRun.slotHint", { slots: timeline.slots })}
              min={1}
              max={Math.max(timeline.slots, 999)}
              allowDecimal={false}
              value={slot + 1}
              onChange={(value) => typeof value === "number" && value >= 1 && setSlot(value - 1)}
            />
            <div>
              <div className={classes.small}>{t("dryRun.order")}</div>
              <Order sequence={timeline.latencies_ms} bodies={timeline.bodies} />
            </div>
            <div>
              <div className={classes.small}>{t("dryRun.replicate")}</div>
              <span className="numbers">{timeline.replicate}</span>
            </div>
            <SegmentedControl
              aria-label={t("dryRun.language")}
              value={timeline.language}
              onChange={setChosenLanguage}
              data={timeline.languages.map((tag) => ({
                value: tag,
                label: LANGUAGE_NAMES[tag] ?? tag,
              }))}
            />
            <p className={classes.total}>
              {t("dryRun.total", {
                total: minutes(timeline.total_s + 60 * (walksBackMin ?? 0), language),
                planned: minutes(timeline.planned_s, language),
              })}
              {walksBackMin !== null &&
                `. ${t("pilot.walksBack", { back: number(walksBackMin, language, 1) })}`}
            </p>
          </div>
          <Bars timeline={timeline} />
          <Steps timeline={timeline} />
          <p className={classes.small}>
            {t("dryRun.rule", {
              words: Math.round(timeline.rule.reading_words_per_s * 60),
              likert: timeline.rule.item_s.likert ?? 0,
              opening: timeline.rule.opening_s,
            })}
          </p>
        </>
      )}
    </Loaded>
  );
}

const minutes = (time: number, language: string): string => number(time / 60, language, 1);

/** Okabe and Ito's colours, distinguishable by nearly everybody; a pattern and a word are added. */
const HUES = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#f0e442"];

interface Level {
  readonly condition: string;
  readonly latencyMs: number;
  readonly body: string | null;
}

/** The conditions by latency, so that their colours are the same in every order. */
function levelsOf({ sequence, latencies_ms, bodies }: Timeline): readonly Level[] {
  return sequence
    .map((condition, at) => ({
      condition,
      latencyMs: latencies_ms[at] ?? 0,
      body: bodies?.[at] ?? null,
    }))
    .sort(
      (one, other) =>
        one.latencyMs - other.latencyMs || one.condition.localeCompare(other.condition),
    );
}

function hueOf(timeline: Timeline, step: TimelineStep): string | undefined {
  if (step.block === null) return undefined;
  const rank = levelsOf(timeline).findIndex(({ condition }) => condition === step.condition);
  return HUES[rank % HUES.length];
}

function Bars({ timeline }: { readonly timeline: Timeline }): JSX.Element {
  const { t, language } = useTexts();
  const marks = Array.from({ length: Math.floor(timeline.total_s / 300) + 1 }, (_, at) => at * 5);
  return (
    <figure className={classes.figure}>
      <div
        className={classes.bars}
        role="img"
        aria-label={t("dryRun.figure", { total: minutes(timeline.total_s, language) })}
      >
        {timeline.steps.map((step) => (
          <span
            key={step.index}
            className={`${classes.bar} ${step.estimated ? classes.estimated : ""}`}
            style={
              {
                flexGrow: step.length_s,
                "--hue": hueOf(timeline, step) ?? "var(--line-strong)",
              } as CSSProperties
            }
            title={`${step.title}, ${clockFace(seconds(step.length_s))}`}
          />
        ))}
      </div>
      <div className={`${classes.axis} numbers`} aria-hidden="true">
        {marks.map((mark) => (
          <span
            key={mark}
            style={{ insetInlineStart: `${((mark * 60) / timeline.total_s) * 100}%` }}
          >
            {mark}
          </span>
        ))}
      </div>
      <figcaption className={classes.legend}>
        {levelsOf(timeline).map(({ condition, latencyMs, body }, rank) => (
          <span key={condition}>
            <i style={{ background: HUES[rank % HUES.length] }} />
            {timeline.bodies != null && `${body ?? t("order.configured")}, `}
            {latency(milliseconds(latencyMs))}
          </span>
        ))}
        <span>
          <i style={{ background: "var(--line-strong)" }} />
          {t("dryRun.outside")}
        </span>
        <span>
          <i className={classes.hatched} />
          {t("dryRun.estimated")}
        </span>
        <span>{t("dryRun.axis")}</span>
      </figcaption>
    </figure>
  );
}

function Steps({ timeline }: { readonly timeline: Timeline }): JSX.Element {
  const texts = useTexts();
  const { t } = texts;
  return (
    <ScrollBox label={t("dryRun.step")} className={classes.scroll}>
      <table className={`${classes.table} numbers`}>
        <thead>
          <tr>
            <th scope="col">{t("dryRun.at")}</th>
            <th scope="col">{t("dryRun.step")}</th>
            <th scope="col">{t("dryRun.condition")}</th>
            <th scope="col">{t("dryRun.time")}</th>
            <th scope="col">{t("dryRun.parts")}</th>
            <th scope="col">{t("dryRun.text")}</th>
          </tr>
        </thead>
        <tbody>
          {timeline.steps.map((step) => (
            <tr key={step.index}>
              <td>{clockFace(seconds(step.start_s))}</td>
              <td>
                {step.title}
                <div className={classes.small}>{step.key}</div>
                {step.avatar_changes != null && (
                  <div className={classes.small}>
                    {t("avatarChanges.inPhase")}{" "}
                    {changeWords(texts, step.avatar_changes).join(" · ")}
                  </div>
                )}
              </td>
              <td>
                {step.condition_label !== null && (
                  <span className={classes.condition}>
                    <i style={{ background: hueOf(timeline, step) }} />
                    {step.condition_label}
                  </span>
                )}
              </td>
              <td>
                {step.estimated ? "≈ " : ""}
                {clockFace(seconds(step.length_s))}
              </td>
              <td>{parts(step)}</td>
              <td lang={timeline.language}>
                {step.text != null && <ShownText text={step.text} />}
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </ScrollBox>
  );
}

/** A text in two lines, and as the participant reads it once it is opened. */
function ShownText({ text }: { readonly text: string }): JSX.Element {
  const { t, language } = useTexts();
  return (
    <details className={classes.shown}>
      <summary>
        <span className={classes.words}>{withoutMarks(text)}</span>
        <span className={classes.less} lang={language}>
          {t("dryRun.text.less")}
        </span>
      </summary>
      <Prose text={text} t={t} />
    </details>
  );
}

const parts = (step: TimelineStep): string =>
  step.duration_s === null
    ? ""
    : [step.preparation_s, step.duration_s, step.freeze_s]
        .filter((part) => part !== null)
        .map((part) => `${part} s`)
        .join(" + ");
