/** The current error of each joint: a small body, and the largest errors by name. */
import type { JointErrors } from "@shared/api/replays";
import { BODY } from "@shared/bodyJoints";
import { decimals } from "@shared/format";
import type { Seconds } from "@shared/units";
import type { JSX } from "react";
import { placeOnBody } from "../captures/bodyJoints";
import { FULL_SCALE_DEG } from "../cockpit/live3d/heat";
import { useTexts } from "../i18n";
import classes from "./Replay.module.css";

interface ErrorMapProps {
  readonly errors: JointErrors;
  readonly time: Seconds;
}

const MAX_LISTED = 5;

export function ErrorMap({ errors, time }: ErrorMapProps): JSX.Element {
  const { t, language } = useTexts();
  const now = errorsAt(errors, time);
  const all = overall(now);
  return (
    <section className={classes.errors} title={t("replay.errors.hint")}>
      <h2 className={classes.sideTitle}>
        {t("replay.errors")}
        <span className={`${classes.soft} numbers`}>
          {all === null
            ? t("replay.errors.none")
            : t("replay.errors.overall", { degrees: decimals(all, language, 1) })}
        </span>
      </h2>
      <div className={classes.errorParts}>
        <Body errors={now} label={t("replay.errors.map")} />
        <ul className={`${classes.worst} numbers`}>
          {largest(now, MAX_LISTED).map(({ joint, degrees }) => (
            <li key={joint}>
              <span>{joint.replace(/([a-z])([A-Z])/g, "$1 $2")}</span>
              <span className={classes.worstValue}>{decimals(degrees ?? 0, language, 1)}°</span>
              <span
                className={classes.worstBar}
                style={{ width: `${shareOf(degrees) * 100}%` }}
                aria-hidden="true"
              />
            </li>
          ))}
        </ul>
      </div>
    </section>
  );
}

const shareOf = (degrees: number | null): number => Math.min(1, (degrees ?? 0) / FULL_SCALE_DEG);

function Body({
  errors,
  label,
}: {
  readonly errors: readonly JointError[];
  readonly label: string;
}): JSX.Element {
  return (
    <svg viewBox="-31 0 62 104" className={classes.body} role="img" aria-label={label}>
      {Object.entries(BODY).map(([joint, parent]) => {
        if (parent === null) return null;
        const [x1, y1] = placeOnBody(parent);
        const [x2, y2] = placeOnBody(joint);
        return <line key={joint} {...{ x1, y1, x2, y2 }} />;
      })}
      {errors.map(({ joint, degrees }) => {
        const [cx, cy] = placeOnBody(joint);
        if (degrees === null) return null;
        const isMoved = degrees >= MIN_DEG;
        return (
          <circle
            key={joint}
            cx={cx}
            cy={cy}
            r={1.4 + 6 * Math.sqrt(shareOf(degrees))}
            fillOpacity={isMoved ? 0.35 + 0.6 * shareOf(degrees) : 0.25}
          />
        );
      })}
    </svg>
  );
}

interface JointError {
  readonly joint: string;
  /** Null if it is unknown. */
  readonly degrees: number | null;
}

/** Joint errors without any joint, for a phase that has none. */
export const NO_ERRORS: JointErrors = {
  joints: [],
  frames: 0,
  rateHz: 1,
  values: new Float32Array(),
};

/** The error of each joint, between target and actual rotation, at a moment, s. */
export function errorsAt({ joints, frames, rateHz, values }: JointErrors, time: number) {
  const frame = Math.min(Math.max(Math.round(time * rateHz), 0), frames - 1);
  return joints.map((joint, at): JointError => {
    const radians = frame < 0 ? Number.NaN : (values[frame * joints.length + at] ?? Number.NaN);
    return { joint, degrees: Number.isNaN(radians) ? null : (radians * 180) / Math.PI };
  });
}

/** Smaller errors cannot be distinguished from none. */
const MIN_DEG = 0.05;

export const largest = (errors: readonly JointError[], count: number): readonly JointError[] =>
  [...errors]
    .filter(({ degrees }) => degrees !== null && degrees >= MIN_DEG)
    .sort((one, other) => (other.degrees ?? 0) - (one.degrees ?? 0))
    .slice(0, count);

/** Root mean square over all joints; null if none is known. */
export function overall(errors: readonly JointError[]): number | null {
  const knownErrors = errors.flatMap(({ degrees }) => degrees ?? []);
  if (knownErrors.length === 0) return null;
  return Math.sqrt(knownErrors.reduce((sum, value) => sum + value * value, 0) / knownErrors.length);
}
