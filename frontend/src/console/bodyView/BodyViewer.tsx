/**
 * A body from all sides, in the T-pose, standing or walking; of its own stature or of several, side
 * by side.
 */
import { SegmentedControl } from "@mantine/core";
import { decimals } from "@shared/format";
import type { CameraSide, Figure } from "@shared/stage/figure";
import { durationOf } from "@shared/stage/motion";
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
  /** From where the camera looks first. */
  readonly firstSide?: CameraSide;
}

/** Distance between two bodies, in their statures: room for spread arms. */
const APART = 1.05;
const LABEL_ABOVE_M = 0.09;
const OWN: readonly number[] = [];

export function BodyViewer(props: BodyViewerProps): JSX.Element {
  const { hash, name, staturesM = OWN, height = "clamp(320px, 52vh, 620px)", firstSide } = props;
  const { isLabelled = false } = props;
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
          ),
    [body.model, kind, statures, isLabelled, language],
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
          data={EXAMPLE_POSES.map((value) => ({ value, label: t(`bodyView.pose.${value}`) }))}
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
    </div>
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
): readonly Figure[] {
  const given = wished.filter((stature) => stature > 0);
  const statures = given.length > 0 ? given : [model.binding.stature_m];
  const widths = statures.map((stature) => APART * stature);
  const total = widths.reduce((sum, width) => sum + width, 0);
  let from = -total / 2;
  return statures.map((statureM, index) => {
    const width = widths[index] ?? 0;
    const { motion, pose } = example(model.binding, statureM, kind);
    const figure: Figure = {
      key: `${index} ${statureM}`,
      motion,
      tone: "solid",
      // From the front, which is where bodies face, +x is on the left.
      offset: [statures.length > 1 ? -(from + width / 2) : 0, 0],
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
