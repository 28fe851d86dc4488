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
                <td data-state={state}>{state === undefined ? "–" : t(`body.state.${state}`)}</td>
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
          {t("body.stature", { height: number(calibration.stature_m * 100, language, 1) })}
        </p>
      )}
      {calibration != null && calibration.notices.length > 0 && (
        <Notice tone="warn" title={t("body.notices")}>
          {calibration.notices.join(", ").replaceAll("_", " ")}
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
