/** How one axis responds: its step and torque with old and new gains, and its relay experiment. */
import { Figure } from "@charts/Figure";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { Loaded } from "../../ui/Loaded";
import classes from "../Editor.module.css";
import { type CurveWords, relayFigure, stepFigure, torqueFigure } from "./curveFigures";
import own from "./Tuning.module.css";
import { curvesQuery } from "./tunings";

interface TuningCurvesProps {
  readonly id: string;
  readonly axis: string;
  readonly name: string;
}

export function TuningCurves({ id, axis, name }: TuningCurvesProps): JSX.Element {
  const { t } = useTexts();
  const words: CurveWords = {
    time: t("avatars.curve.time"),
    angle: t("avatars.curve.angle"),
    torque: t("avatars.curve.torque"),
    target: t("avatars.curve.target"),
    before: t("avatars.before"),
    after: t("avatars.after"),
  };
  return (
    <Loaded query={useQuery(curvesQuery(id, axis))}>
      {(curves) => (
        <div className={own.curves}>
          {[
            ["step", stepFigure(curves, words)] as const,
            ["torque", torqueFigure(curves, words)] as const,
            ["relay", relayFigure(curves, words)] as const,
          ].map(
            ([kind, figure]) =>
              figure !== null && (
                <div key={kind}>
                  <h4 className={classes.sub}>{t(`avatars.curve.${kind}`)}</h4>
                  <Figure
                    figure={figure}
                    label={`${name}: ${t(`avatars.curve.${kind}`)}`}
                    watermark={null}
                    loading={t("walking.drawing")}
                    failed={t("walking.notDrawn")}
                  />
                </div>
              ),
          )}
        </div>
      )}
    </Loaded>
  );
}
