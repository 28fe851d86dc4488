/** The procedure from top to bottom: steps that are done, running and to come. */

import type { PhaseSummary, SessionView, Step } from "@shared/api/types";
import { duration, latency } from "@shared/format";
import { isCrossing } from "@shared/session/steps";
import { milliseconds, seconds } from "@shared/units";
import { type JSX, useEffect, useRef } from "react";
import { useTexts } from "../../i18n";
import { isCounted, stepName } from "../../steps";
import cockpit from "../Cockpit.module.css";
import { AchievedInBrief } from "./AchievedLatency";
import classes from "./Timeline.module.css";

export function Timeline({ session }: { readonly session: SessionView }): JSX.Element {
  const label = useTexts().t("timeline.label");
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: a scrollable region has to be focusable
    <nav className={cockpit.steps} tabIndex={0} data-tour="timeline" aria-label={label}>
      {groupSteps(session.steps).map((group) => (
        <Group key={group.steps[0]?.index} group={group} session={session} />
      ))}
    </nav>
  );
}

interface GroupProps {
  readonly group: StepGroup;
  readonly session: SessionView;
}

function Group({ group, session }: GroupProps): JSX.Element {
  const { t } = useTexts();
  const worn = group.steps.find(({ body }) => body !== null)?.body ?? null;
  const title =
    group.block === null
      ? t(group.steps[0]?.index === 0 ? "timeline.before" : "timeline.after")
      : t("timeline.block", { number: group.number });
  return (
    <section className={classes.group}>
      <h2 className={classes.groupTitle}>
        {title}
        {group.block !== null && (
          <span className="numbers">
            {group.latency === null ? t("timeline.hidden") : latency(milliseconds(group.latency))}
            {worn !== null && ` · ${worn}`}
          </span>
        )}
      </h2>
      <ol className={classes.list}>
        {group.steps.map((step) => (
          <StepRow key={step.index} step={step} phase={lastPhase(session, step)} />
        ))}
      </ol>
    </section>
  );
}

const lastPhase = (session: SessionView, step: Step): PhaseSummary | undefined =>
  session.phases.filter((phase) => phase.step_index === step.index).at(-1);

interface StepRowProps {
  readonly step: Step;
  readonly phase: PhaseSummary | undefined;
}

function StepRow({ step, phase }: StepRowProps): JSX.Element {
  const { t } = useTexts();
  const row = useRef<HTMLLIElement>(null);
  const current = step.status === "current";
  useEffect(() => {
    if (current && row.current !== null) showInList(row.current);
  }, [current]);
  return (
    <li
      ref={row}
      className={`${classes.step} ${classes[step.status]}`}
      aria-current={current ? "step" : undefined}
    >
      <StepMark status={step.status} />
      <span>
        {t(stepName(step))}
        <span className="visually-hidden">, {t(`timeline.${step.status}`)}</span>
        <StepDetails step={step} phase={phase} />
        {phase !== undefined && step.status === "done" && (
          <span className={classes.sub}>
            <AchievedInBrief phase={phase} />
          </span>
        )}
      </span>
    </li>
  );
}

/** Scroll the list, not the page: on a narrow screen the list does not scroll and stands below. */
function showInList(row: HTMLElement): void {
  const list = row.closest("nav");
  if (list === null || list.scrollHeight <= list.clientHeight) return;
  const [of, inside] = [row.getBoundingClientRect(), list.getBoundingClientRect()];
  if (of.top < inside.top) list.scrollTop += of.top - inside.top;
  else if (of.bottom > inside.bottom) list.scrollTop += of.bottom - inside.bottom;
}

function StepDetails({ step, phase }: StepRowProps): JSX.Element | null {
  const { t } = useTexts();
  const parts: string[] = [];
  if (step.status === "skipped") parts.push(step.reason ?? t("timeline.skipped"));
  else if (phase !== undefined && step.status === "done" && isCounted(step)) {
    // A blinded reader gets the counts once the phase has ended.
    const { completions, side_contacts: contacts } = phase;
    const isRoad = isCrossing(step);
    const counted = isRoad ? "timeline.crossings" : "timeline.completions";
    if (completions !== null) parts.push(t(counted, { count: completions }));
    if (contacts !== null && !isRoad) parts.push(t("timeline.contacts", { count: contacts }));
  } else if (step.duration_s !== null && step.status !== "done") {
    parts.push(duration(seconds(step.duration_s)));
  }
  if (step.attempt > 1) parts.push(t("timeline.attempt", { number: step.attempt }));
  return parts.length === 0 ? null : <span className={classes.sub}>{parts.join(" · ")}</span>;
}

function StepMark({ status }: { readonly status: Step["status"] }): JSX.Element {
  return (
    <svg className={classes.mark} width="22" height="22" viewBox="0 0 22 22" aria-hidden="true">
      {status === "pending" && (
        <circle cx="11" cy="11" r="7" fill="none" stroke="var(--line-strong)" strokeWidth="1.5" />
      )}
      {status === "current" && (
        <>
          <circle cx="11" cy="11" r="8.5" fill="none" stroke="var(--accent)" strokeWidth="2" />
          <circle cx="11" cy="11" r="4" fill="var(--accent)" />
        </>
      )}
      {status === "done" && (
        <>
          <circle cx="11" cy="11" r="8.5" fill="var(--accent)" />
          <path
            d="m7 11.3 2.8 2.8L15.3 8.3"
            fill="none"
            stroke="var(--on-accent)"
            strokeWidth="2"
            strokeLinecap="round"
            strokeLinejoin="round"
          />
        </>
      )}
      {status === "skipped" && (
        <>
          <circle
            cx="11"
            cy="11"
            r="8"
            fill="none"
            stroke="var(--warn-line)"
            strokeWidth="1.5"
            strokeDasharray="3 2.4"
          />
          <path
            d="M8 7.8v6.4l4.4-3.2ZM14 7.8v6.4"
            fill="var(--warn-line)"
            stroke="var(--warn-line)"
            strokeWidth="1.4"
          />
        </>
      )}
    </svg>
  );
}

interface StepGroup {
  readonly block: number | null;
  /** The number of the block in this session, counted from 1; 0 outside blocks. */
  readonly number: number;
  /** The block's condition; null if it is hidden or there is none. */
  readonly latency: number | null;
  readonly steps: readonly Step[];
}

/** The steps of a session, grouped into those before the blocks, the blocks, and those after. */
export function groupSteps(steps: readonly Step[]): readonly StepGroup[] {
  const groups: { block: number | null; number: number; latency: number | null; steps: Step[] }[] =
    [];
  let blocks = 0;
  for (const step of steps) {
    const last = groups.at(-1);
    if (last !== undefined && last.block === step.block) {
      last.steps.push(step);
      continue;
    }
    if (step.block !== null) blocks += 1;
    const number = step.block === null ? 0 : blocks;
    const latency = step.block === null ? null : step.latency_ms;
    groups.push({ block: step.block, number, latency, steps: [step] });
  }
  return groups;
}
