/** The skeleton in 3-D and a drawing of the body, with the joint being edited marked in both. */
import { Center, Loader } from "@mantine/core";
import type { Capture } from "@shared/api/captures";
import { BODY } from "@shared/bodyJoints";
import { type Figure, LEFT_COLOUR, RIGHT_COLOUR } from "@shared/stage/figure";
import { Stage } from "@shared/stage/Stage";
import { seconds } from "@shared/units";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useMemo } from "react";
import { Failure } from "../errors";
import { type Key, useTexts } from "../i18n";
import { placeOnBody, rolesFrom } from "./bodyJoints";
import classes from "./JointMap.module.css";
import type { BodyMap, MapProblem } from "./jointMapEdit";
import { motionQuery } from "./queries";
import { useStageTexts } from "./useStageTexts";

interface MapPreviewProps {
  readonly capture: Capture;
  readonly joints: BodyMap;
  readonly editing: string | null;
  readonly problems: ReadonlyMap<string, MapProblem>;
}

const START = seconds(0);
const MARKS = ["full", "hollow", "cross"] as const;

export function MapPreview({ capture, joints, editing, problems }: MapPreviewProps): JSX.Element {
  const { t } = useTexts();
  const texts = useStageTexts();
  const query = useQuery(motionQuery(capture, "skeleton"));
  const motion = query.data;
  const marked = motion?.names.indexOf(joints[editing ?? ""] ?? "") ?? -1;
  const figures = useMemo((): readonly Figure[] => {
    if (motion === undefined) return [];
    // The first frame alone, so that the floor fits closely around the body.
    const still = {
      ...motion,
      frames: 1,
      positions: motion.positions.subarray(0, 3 * motion.names.length),
    };
    return [
      {
        key: "skeleton",
        motion: still,
        tone: "solid",
        roles: rolesFrom(motion.names, joints),
        highlighted: marked < 0 ? null : marked,
      },
    ];
  }, [motion, joints, marked]);
  const played = editing === null ? undefined : joints[editing];
  return (
    <div className={classes.preview}>
      <div className={classes.stage}>
        {query.isError && <Failure error={query.error} />}
        {motion === undefined && !query.isError && (
          <Center h="100%">
            <Loader />
          </Center>
        )}
        {motion !== undefined && (
          <Stage
            figures={figures}
            time={START}
            mode="orbit"
            label={t("capture.picture", {
              title: capture.title,
              what: t("captures.kind.skeleton", { count: motion.names.length }),
            })}
            texts={texts}
          />
        )}
      </div>
      <div className={classes.body}>
        <BodyFigure joints={joints} editing={editing} problems={problems} />
        <div className={classes.marked} aria-live="polite">
          {editing !== null && (
            <>
              <strong>{t(`joint.${editing}` as Key)}</strong>
              <span>{played ?? t("map.unmapped")}</span>
            </>
          )}
          {editing === null && <Legend />}
        </div>
      </div>
    </div>
  );
}

/** The legend of the marks on the body, shown while there is nothing else to say about it. */
function Legend(): JSX.Element {
  const { t } = useTexts();
  return (
    <ul className={classes.legend}>
      {MARKS.map((mark) => (
        <li key={mark}>
          <svg viewBox="-5 -5 10 10" aria-hidden="true" data-mark={mark}>
            {mark === "cross" ? <path d="M-3 -3L3 3M3 -3L-3 3" /> : <circle r={3.2} />}
          </svg>
          {t(`map.legend.${mark}`)}
        </li>
      ))}
    </ul>
  );
}

type BodyFigureProps = Omit<MapPreviewProps, "capture">;

/** The body's joints: filled if assigned, hollow if not, a cross if there is a problem. */
function BodyFigure({ joints, editing, problems }: BodyFigureProps): JSX.Element {
  const { t } = useTexts();
  return (
    <svg className={classes.figure} role="img" aria-label={t("map.figure")} viewBox="-30 0 60 102">
      {Object.entries(BODY).map(([joint, above]) => {
        if (above === null) return null;
        const [x1, y1] = placeOnBody(above);
        const [x2, y2] = placeOnBody(joint);
        return <line key={joint} {...{ x1, y1, x2, y2 }} stroke="var(--line-strong)" />;
      })}
      {Object.keys(BODY).map((joint) => {
        const [cx, cy] = placeOnBody(joint);
        const colour = colourOf(joint);
        const isMapped = joints[joint] !== undefined;
        return (
          <g key={joint}>
            <title>{`${t(`joint.${joint}` as Key)}: ${joints[joint] ?? t("map.unmapped")}`}</title>
            {joint === editing && (
              <circle cx={cx} cy={cy} r={5} fill="var(--warn-soft)" stroke="var(--warn-line)" />
            )}
            <circle
              cx={cx}
              cy={cy}
              r={2.3}
              fill={isMapped ? colour : "var(--surface)"}
              stroke={colour}
              strokeWidth={1}
            />
            {problems.has(joint) && (
              <path
                d={`M${cx - 3.4} ${cy - 3.4}l6.8 6.8m0 -6.8l-6.8 6.8`}
                stroke="var(--bad)"
                strokeWidth={1.4}
              />
            )}
          </g>
        );
      })}
    </svg>
  );
}

function colourOf(joint: string): string {
  if (joint.startsWith("Left")) return LEFT_COLOUR;
  return joint.startsWith("Right") ? RIGHT_COLOUR : "var(--accent)";
}
