/**
 * The procedure of one session from left to right; timed parts show their seconds, phases are to
 * scale.
 */

import type {
  CrossingPhase,
  SetupStep,
  Step,
  StudyDetail,
  StudyProtocol,
  TaskPhase,
} from "@shared/api/types";
import { duration, number } from "@shared/format";
import { CROSSING } from "@shared/session/steps";
import { Icon, type IconName } from "@shared/ui/Icon";
import { seconds } from "@shared/units";
import type { JSX } from "react";
import { type Key, useTexts } from "../../i18n";
import { stepIcon, stepName } from "../../steps";
import classes from "./Procedure.module.css";

interface ProcedureProps {
  readonly study: StudyDetail;
  readonly protocol: StudyProtocol;
  /** Walks back in minutes, as a pilot of this version says; null without one. */
  readonly walksBackMin?: number | null;
}

export function Procedure({ study, protocol, walksBackMin = null }: ProcedureProps): JSX.Element {
  const { t, language } = useTexts();
  const { before, block, after } = protocol.procedure;
  return (
    <>
      <div className={classes.row}>
        <Part name={t("procedure.before")} kind="before" steps={before} />
        <div className={`${classes.part} ${classes.block}`}>
          <span className={classes.label}>
            {t("procedure.block", { count: protocol.conditions.length })}
          </span>
          <ol className={classes.steps}>
            {block.crossing !== undefined && (
              <Phase
                phase={block.crossing}
                step={CROSSED}
                until={t("procedure.crossings", { count: block.crossing.crossings })}
              />
            )}
            {block.phases.map((phase) => (
              <Phase key={phase.limb} phase={phase} step={{ kind: "task", limb: phase.limb }} />
            ))}
            {(block.after ?? []).map((step, index) => (
              // biome-ignore lint/suspicious/noArrayIndexKey: the steps of a protocol never change places
              <SmallStep key={index} icon={stepIcon(named(step))} name={stepName(named(step))} />
            ))}
          </ol>
        </div>
        <Part name={t("procedure.after")} kind="after" steps={after} />
      </div>
      <div className={classes.legend}>
        <span>{t("procedure.legend")}</span>
        <span className={classes.total}>
          {t("procedure.total", {
            minutes: number(study.minutes + (walksBackMin ?? 0), language, 0),
            planned: number(study.planned_minutes, language, 0),
          })}
          {walksBackMin !== null &&
            ` ${t("pilot.walksBack", { back: number(walksBackMin, language, 1) })}`}
        </span>
      </div>
    </>
  );
}

interface PartProps {
  readonly name: string;
  readonly kind: "before" | "after";
  readonly steps: readonly SetupStep[];
}

/** A step of the file in the form of a session's steps. */
const named = ({ step, limb }: SetupStep) => ({ kind: step, limb: limb ?? null });

const CROSSED = { kind: CROSSING, limb: null };
const QUESTIONNAIRE = { kind: "questionnaire", limb: null } as const;

function Part({ name, kind, steps }: PartProps): JSX.Element {
  return (
    <div className={`${classes.part} ${classes[kind]}`}>
      <span className={classes.label}>{name}</span>
      <ol className={classes.steps}>
        {steps.map((step, index) => (
          <SmallStep
            // biome-ignore lint/suspicious/noArrayIndexKey: the steps of a protocol never change places
            key={index}
            icon={stepIcon(named(step))}
            name={stepName(named(step))}
          >
            {step.duration_s === undefined ? null : duration(seconds(step.duration_s))}
          </SmallStep>
        ))}
      </ol>
    </div>
  );
}

interface SmallStepProps {
  readonly icon: IconName;
  readonly name: Key;
  readonly children?: string | null;
}

function SmallStep({ icon, name, children }: SmallStepProps): JSX.Element {
  const { t } = useTexts();
  return (
    <li className={classes.step}>
      <Icon name={icon} />
      <span>
        {t(name)}
        {children != null && <span className={classes.time}>{children}</span>}
      </span>
    </li>
  );
}

interface PhaseProps {
  readonly phase: TaskPhase | CrossingPhase;
  readonly step: Pick<Step, "kind" | "limb">;
  /** What else ends the phase, before its time is over. */
  readonly until?: string;
}

function Phase({ phase, step, until }: PhaseProps): JSX.Element {
  const { t } = useTexts();
  const segments = [
    ["preparation", phase.preparation_s],
    ["active", phase.duration_s],
    ["freeze", phase.freeze_s],
  ] as const;
  return (
    <>
      <li className={`${classes.step} ${classes.phase}`}>
        <span className={classes.phaseName}>
          <Icon name={stepIcon(step)} />
          {t(stepName(step))}
        </span>
        <span className={`${classes.scale} numbers`}>
          {segments.map(([name, time]) => (
            <span
              key={name}
              className={`${classes.segment} ${name === "active" ? classes.active : ""}`}
              style={{ flexGrow: time }}
              title={t(`procedure.${name}`)}
            >
              {time} s
            </span>
          ))}
        </span>
        {until !== undefined && <span className={classes.until}>{until}</span>}
      </li>
      {phase.questionnaire !== null && (
        <SmallStep icon={stepIcon(QUESTIONNAIRE)} name={stepName(QUESTIONNAIRE)} />
      )}
    </>
  );
}
