/**
 * A body from all sides, in the T-pose, standing or walking; of its own stature or of several, side
 * by side.
 */
import { SegmentedControl } from "@mantine/core";
import { decimals } from "@shared/format";
import type { CameraSide, Figure } from "@shared/stage/figure";
import { durationOf, type PointMotion } from "@shared/stage/motion";
import { Stage, type StageHandle } from "@shared/stage/Stage";
import type { BodyModel } from "@shared/stage/skin/bodyModel";
import { usePlayback } from "@shared/stage/usePlayback";
import { seconds } from "@shared/units";
import { type JSX, useEffect, useMemo, useRef, useState } from "react";
import { AVATAR_MAP, rolesFrom } from "../captures/bodyJoints";
import { useStageTexts } from "../captures/useStageTexts";
import { useTexts } from "../i18n";
import { BodyNotice } from "./BodyNotice";
import classes from "./BodyViewer.module.css";
import { CameraSides } from "./CameraSides";
import { EXAMPLE_POSES, type ExamplePose, example } from "./examplePoses";
import { useBody } from "./useBody";
import { wornBy } from "./worn";

export interface BodyViewerProps {
  /** The content hash of the body's model. */
  readonly hash: string;
  /** What the body is called. */
  readonly name: string;
  /** Statures to show it in, metres, side by side; the model's own if there are none. */
  readonly staturesM?: readonly number[];
  /** Whether the stature stands above each figure. */
  readonly isLabelled?: boolean;
  /** Height of the picture in CSS; by default a part of the window's. */
  readonly height?: string;
  /** A recorded walk for the statures, instead of the generated one. */
  readonly recorded?: RecordedWalk | undefined;
  /** From where the camera looks first. */
  readonly firstSide?: CameraSide;
}

export interface RecordedWalk {
  readonly title: string;
  /** One for each stature; null until all are there. */
  readonly motions: readonly PointMotion[] | null;
}

/** A drawn body that is this share taller or shorter than its stature is told. */
const TELLING = 0.03;
/** Distance between two bodies, in their statures: room for spread arms. */
const APART = 1.05;
const LABEL_ABOVE_M = 0.09;
const OWN: readonly number[] = [];

export function BodyViewer(props: BodyViewerProps): JSX.Element {
  const { hash, name, staturesM = OWN, height = "clamp(320px, 52vh, 620px)", firstSide } = props;
  const { isLabelled = false, recorded } = props;
  const { t, language } = useTexts();
  const texts = useStageTexts();
  const body = useBody(hash);
  const [kind, setKind] = useState<ExamplePose>("stand");
  const stage = useRef<StageHandle>(null);
  const statures = staturesM.join(" ");
  const figures = useMemo(
    () =>
      body.model === null
        ? NOBODY
        : figuresOf(
            body.model,
            kind,
            statures.split(" ").map(Number),
            isLabelled ? (statureM) => `${decimals(100 * statureM, language, 0)} cm` : null,
            kind === "walk" ? (recorded?.motions ?? null) : null,
          ),
    [body.model, kind, statures, isLabelled, language, recorded?.motions],
  );
  const motion = figures[0]?.motion;
  const playback = usePlayback(motion === undefined ? seconds(0) : durationOf(motion));
  const { playing, toggle } = playback;
  const moves = (motion?.frames ?? 0) > 1 && !prefersStillness();
  useEffect(() => {
    if (moves && !playing) toggle();
  }, [moves, playing, toggle]);
  return (
    <div className={classes.viewer}>
      <div className={classes.bar}>
        <SegmentedControl
          size="xs"
          aria-label={t("bodyView.pose")}
          value={kind}
          onChange={(value) => setKind(value as ExamplePose)}
          data={EXAMPLE_POSES.map((value) => ({
            value,
            label: t(
              value === "walk" && recorded !== undefined
                ? "bodyView.pose.recorded"
                : `bodyView.pose.${value}`,
            ),
          }))}
        />
        <CameraSides onLook={(from) => stage.current?.placeCamera(from)} />
      </div>
      <div className={classes.stage} style={{ height }}>
        {figures.length > 0 && (
          <Stage
            handle={stage}
            {...(firstSide === undefined ? {} : { firstSide })}
            figures={figures}
            time={playback.time}
            mode="orbit"
            label={t("bodyView.picture", { name })}
            texts={texts}
          />
        )}
        <BodyNotice body={body} />
      </div>
      {recorded !== undefined && kind === "walk" && (
        <p className={classes.caption} role="status">
          {recorded.motions === null
            ? t("bodyView.recorded.loading", { title: recorded.title })
            : recorded.title}
        </p>
      )}
      {staturesM.length === 0 && body.model !== null && <Heights model={body.model} />}
    </div>
  );
}

/** Stature by the skeleton beside what is drawn, where they differ: a cartoon's head, hair, a hat. */
function Heights({ model }: { readonly model: BodyModel }): JSX.Element | null {
  const { t, language } = useTexts();
  const { stature_m: statureM } = model.binding;
  const { drawnHeightM } = model;
  if (Math.abs(drawnHeightM / statureM - 1) < TELLING) return null;
  return (
    <p className={`${classes.caption} numbers`}>
      {t("bodyView.heights", {
        stature: decimals(100 * statureM, language, 0),
        drawn: decimals(drawnHeightM, language, 2),
      })}
    </p>
  );
}

const NOBODY: readonly Figure[] = [];

const prefersStillness = (): boolean =>
  window.matchMedia("(prefers-reduced-motion: reduce)").matches;

function figuresOf(
  model: BodyModel,
  kind: ExamplePose,
  wished: readonly number[],
  labelOf: ((statureM: number) => string) | null,
  recorded: readonly PointMotion[] | null,
): readonly Figure[] {
  const given = wished.filter((stature) => stature > 0);
  const statures = given.length > 0 ? given : [model.binding.stature_m];
  const widths = statures.map((stature) => APART * stature);
  const total = widths.reduce((sum, width) => sum + width, 0);
  let from = -total / 2;
  return statures.map((statureM, index) => {
    const width = widths[index] ?? 0;
    const own = recorded?.[index];
    const shown = own === undefined ? null : wornBy(own, model, statureM).worn;
    const { motion, pose } =
      own === undefined || shown == null
        ? example(model.binding, statureM, kind)
        : { motion: own, pose: shown.pose };
    const [x = 0, , z = 0] = own === undefined ? [] : own.positions;
    const figure: Figure = {
      key: `${index} ${statureM}`,
      motion,
      tone: "solid",
      // From the front, which is where bodies face, +x is on the left.
      // A recorded walk begins where it was recorded.
      offset: [
        (statures.length > 1 ? -(from + width / 2) : 0) - (Number.isFinite(x) ? x : 0),
        Number.isFinite(z) ? -z : 0,
      ],
      roles: rolesFrom(motion.names, AVATAR_MAP),
      worn: { model, statureM, pose },
      ...(labelOf === null
        ? {}
        : { label: { text: labelOf(statureM), heightM: statureM + LABEL_ABOVE_M } }),
    };
    from += width;
    return figure;
  });
}
