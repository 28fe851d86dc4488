/** How the headset tracks and is calibrated to the participant, and the orders to correct it. */
import { Button, NumberInput, Select } from "@mantine/core";
import type { components } from "@shared/api/schema";
import type { SessionView } from "@shared/api/types";
import { number } from "@shared/format";
import { Notice } from "@shared/ui/Notice";
import { type JSX, useState } from "react";
import { useTexts } from "../../i18n";
import cockpit from "../Cockpit.module.css";
import type { useSession } from "../session/useSession";
import classes from "./BodyPanel.module.css";

type Goal = components["schemas"]["TrackerShift"]["goal"];

const GOALS: readonly Goal[] = [
  "Head",
  "LeftHand",
  "RightHand",
  "LeftLowerLeg",
  "RightLowerLeg",
  "Hips",
];
/** A goal that is further off than this in the test poses should be calibrated again. */
const TOO_FAR_CM = 3;

interface BodyPanelProps {
  readonly session: SessionView;
  readonly live: ReturnType<typeof useSession>;
}

/** Whether the headset has said anything about the body. */
export const knowsBody = ({ goals, calibration }: SessionView): boolean =>
  goals != null || calibration != null;

export function BodyPanel({ session, live }: BodyPanelProps): JSX.Element {
  const { t, language } = useTexts();
  const { goals, calibration } = session;
  const may = session.allowed.includes("calibrate");
  const isWorn = calibration?.notices.includes("nothing_worn") !== true;
  return (
    <section aria-label={t("body.title")}>
      <h2 className={cockpit.sectionTitle}>{t("body.title")}</h2>
      <table className={`${classes.goals} numbers`}>
        <thead>
          <tr>
            <th scope="col">{t("body.part")}</th>
            <th scope="col">{t("body.known")}</th>
            <th scope="col">{t("body.off")}</th>
          </tr>
        </thead>
        <tbody>
          {GOALS.map((goal) => {
            const state = goals?.states[goal];
            const offCm = calibration?.residuals_cm[goal];
            return (
              <tr key={goal}>
                <th scope="row">{t(`body.goal.${goal}`)}</th>
                <td data-state={state}>
                  {state === undefined ? "–" : t(stateWord(state, isWorn))}
                </td>
                <td data-off={offCm !== undefined && offCm > TOO_FAR_CM}>
                  {offCm === undefined ? "–" : `${number(offCm, language, 1)} cm`}
                </td>
              </tr>
            );
          })}
        </tbody>
      </table>
      {calibration?.stature_m != null && (
        <p className={classes.measured}>
          {t(isWorn ? "body.stature" : "body.assumed", {
            height: number(calibration.stature_m * 100, language, 1),
          })}
        </p>
      )}
      {isWorn && calibration?.span_m != null && (
        <p className={classes.measured}>
          {t("body.span", { span: number(calibration.span_m * 100, language, 1) })}
        </p>
      )}
      {calibration?.underway != null && <Underway step={calibration.underway} />}
      {calibration != null && calibration.notices.length > 0 && (
        <Notice
          tone={calibration.notices.every(isPlain) ? "info" : "warn"}
          title={t(isWorn ? "body.notices" : "body.uncalibrated")}
        >
          <ul className={classes.notices}>
            {calibration.notices.map((notice) => (
              <li key={notice}>{said(t, "body.notice", notice)}</li>
            ))}
          </ul>
        </Notice>
      )}
      {calibration?.wanted === true && <p className={classes.measured}>{t("body.wanted")}</p>}
      {may && (
        <>
          <Button
            size="xs"
            variant="light"
            disabled={calibration?.wanted === true}
            loading={live.sending}
            onClick={() => live.send({ type: "calibrate" })}
          >
            {t("body.calibrate")}
          </Button>
          <Shift session={session} live={live} />
        </>
      )}
    </section>
  );
}

type State = NonNullable<SessionView["goals"]>["states"][Goal];

/** Mouse, keyboard, scripts and recordings give a part its place; nothing is measured by them. */
const stateWord = (state: NonNullable<State>, isWorn: boolean) =>
  isWorn || state !== "tracked" ? (`body.state.${state}` as const) : "body.state.given";

/** What was noticed and is as it should be: it only says what is not there. */
const PLAIN: ReadonlySet<string> = new Set(["waist_inferred", "feet_not_tracked", "nothing_worn"]);
const isPlain = (notice: string): boolean => PLAIN.has(notice);

type T = ReturnType<typeof useTexts>["t"];

/** A word of the headset in the language of the console; as it is, if there is no text for it. */
function said(t: T, about: "body.notice" | "body.problem" | "body.step", word: string): string {
  const key = `${about}.${word}`;
  const text = t(key as Parameters<T>[0]);
  return text === key ? word.replaceAll("_", " ") : text;
}

interface UnderwayProps {
  readonly step: NonNullable<NonNullable<SessionView["calibration"]>["underway"]>;
}

/** The step that the participant is asked for now, and what keeps it from being done. */
function Underway({ step }: UnderwayProps): JSX.Element {
  const { t } = useTexts();
  const { number: at, total, problem } = step;
  return (
    <output className={classes.measured}>
      {t("body.underway", { number: at, total, step: said(t, "body.step", step.step) })}
      {problem != null && <strong> {said(t, "body.problem", problem)}</strong>}
    </output>
  );
}

const AXES = ["right", "up", "back"] as const;

/** Shift one joint from where its tracker says, in centimetres; zeros take the shift back. */
function Shift({ session, live }: BodyPanelProps): JSX.Element {
  const { t } = useTexts();
  const [goal, setGoal] = useState<Goal>("LeftHand");
  const inForce = session.calibration?.shifts_cm[goal] ?? [0, 0, 0];
  const [typed, setTyped] = useState<readonly (number | null)[]>([null, null, null]);
  const shift = AXES.map((_, at) => typed[at] ?? inForce[at] ?? 0);
  const choose = (name: string | null) => {
    setGoal(GOALS.find((one) => one === name) ?? goal);
    setTyped([null, null, null]);
  };
  return (
    <details className={classes.shift}>
      <summary>{t("body.shift")}</summary>
      <p className={classes.measured}>{t("body.shift.help")}</p>
      <Select
        size="xs"
        label={t("body.part")}
        allowDeselect={false}
        value={goal}
        data={GOALS.map((value) => ({ value, label: t(`body.goal.${value}`) }))}
        onChange={choose}
      />
      <div className={classes.axes}>
        {AXES.map((axis, at) => (
          <NumberInput
            key={axis}
            size="xs"
            label={t(`body.shift.${axis}`)}
            suffix=" cm"
            min={-50}
            max={50}
            step={0.5}
            decimalScale={1}
            value={shift[at] ?? 0}
            onChange={(value) =>
              setTyped(typed.map((one, other) => (other === at ? Number(value) || 0 : one)))
            }
          />
        ))}
      </div>
      <Button
        size="xs"
        variant="default"
        loading={live.sending}
        onClick={() => {
          const [right_cm = 0, up_cm = 0, back_cm = 0] = shift;
          live.send({ type: "shift_tracker", tracker_shift: { goal, right_cm, up_cm, back_cm } });
        }}
      >
        {t("body.shift.do")}
      </Button>
    </details>
  );
}
