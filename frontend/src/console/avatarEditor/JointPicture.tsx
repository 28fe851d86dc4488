/** The body in 3-D with the limits of the chosen joint's axes, and sliders for its angles. */
import { Checkbox, useComputedColorScheme } from "@mantine/core";
import { decimals } from "@shared/format";
import type { Vector } from "@shared/rotations";
import { type Figure, paletteOf } from "@shared/stage/figure";
import { SideView } from "@shared/stage/SideView";
import type { BodyModel } from "@shared/stage/skin/bodyModel";
import { livePose, Parts } from "@shared/stage/skin/pose";
import { useDrawing } from "@shared/stage/useDrawing";
import { Notice } from "@shared/ui/Notice";
import { seconds } from "@shared/units";
import { type JSX, type PointerEvent, useEffect, useMemo, useRef, useState } from "react";
import { axisName } from "../avatarChanges/axes";
import { BodyNotice } from "../bodyView/BodyNotice";
import { CameraSides } from "../bodyView/CameraSides";
import { useBody } from "../bodyView/useBody";
import { AVATAR_MAP, rolesFrom } from "../captures/bodyJoints";
import { useStageTexts } from "../captures/useStageTexts";
import { useTexts } from "../i18n";
import { type AvatarFile, partOf } from "./axes";
import classes from "./Editor.module.css";
import {
  type Angles,
  angleOf,
  JOINTS,
  PARENTS,
  type PlacedAxis,
  placedAxes,
  poseValues,
} from "./pose";

const NOBODY: readonly Figure[] = [];

interface JointPictureProps {
  readonly configuration: AvatarFile;
  /** The body that is drawn: the configuration's own, or one that stands for any. */
  readonly bodyHash: string | null;
  readonly chosen: string | null;
  readonly selected: ReadonlySet<string>;
  readonly onChoose: (axis: string) => void;
}

export function JointPicture(props: JointPictureProps): JSX.Element {
  const { configuration, bodyHash, chosen, selected, onChoose } = props;
  const { t } = useTexts();
  const [angles, setAngles] = useState<Angles>(new Map());
  const [isAll, setAll] = useState(false);
  const body = useBody(bodyHash);
  const setAngle = (axis: string, angleDeg: number) =>
    setAngles((before) => new Map(before).set(axis, angleDeg));
  return (
    <section className={classes.pictureCard} aria-label={t("avatars.picture")}>
      <Picture
        configuration={configuration}
        model={body.model}
        angles={angles}
        chosen={chosen}
        shown={axesShown(configuration, chosen, selected, isAll)}
        onAngle={setAngle}
        onChoose={onChoose}
        notice={<BodyNotice body={body} />}
      />
      <div className={classes.below}>
        <Checkbox
          size="xs"
          label={t("avatars.picture.all")}
          checked={isAll}
          onChange={(event) => setAll(event.currentTarget.checked)}
        />
        <button
          type="button"
          className={classes.plainButton}
          onClick={() => setAngles(new Map())}
          disabled={angles.size === 0}
        >
          {t("avatars.picture.rest")}
        </button>
      </div>
      <JointAngles
        configuration={configuration}
        chosen={chosen}
        angles={angles}
        onAngle={setAngle}
      />
    </section>
  );
}

/** The axes of the chosen and of the selected joints, the chosen one last, so that it is on top. */
function axesShown(
  configuration: AvatarFile,
  chosen: string | null,
  selected: ReadonlySet<string>,
  isAll: boolean,
): readonly string[] {
  const parts = new Set([...selected, ...(chosen === null ? [] : [chosen])].map(partOf));
  return Object.keys(configuration.axes)
    .filter((axis) => isAll || parts.has(partOf(axis)))
    .toSorted((a, b) => Number(a === chosen) - Number(b === chosen));
}

interface PictureProps {
  readonly configuration: AvatarFile;
  readonly model: BodyModel | null;
  readonly angles: Angles;
  readonly chosen: string | null;
  readonly shown: readonly string[];
  readonly onAngle: (axis: string, angleDeg: number) => void;
  readonly onChoose: (axis: string) => void;
  readonly notice: JSX.Element;
}

function Picture(props: PictureProps): JSX.Element {
  const { configuration, model, angles, chosen, shown, onAngle, onChoose, notice } = props;
  const { t } = useTexts();
  const texts = useStageTexts();
  const root = useRef<HTMLDivElement>(null);
  const scheme = useComputedColorScheme("light");
  const { drawingState, drawing } = useDrawing(root, loadScene);
  const standing = useMemo(() => (model === null ? null : standingBody(model)), [model]);
  const grabbed = useRef<PlacedAxis | null>(null);
  useEffect(() => {
    if (drawing === null || root.current === null || scheme === undefined) return;
    drawing.setFirstSide("corner");
    drawing.setFigures(standing?.figures ?? NOBODY, paletteOf(root.current));
    if (standing !== null) drawing.showBody("corner");
  }, [drawing, standing, scheme]);
  useEffect(() => {
    if (drawing === null || standing === null || root.current === null || scheme === undefined) {
      return;
    }
    standing.pose(configuration, angles);
    drawing.show(seconds(0));
    const placed = placedAxes(configuration, angles, standing.model.binding, standing.parts);
    const drawn = shown.flatMap((axis) => {
      const one = placed.get(axis);
      return one === undefined ? [] : [{ placed: one, isChosen: axis === chosen }];
    });
    drawing.setAxes(drawn, paletteOf(root.current));
  }, [drawing, standing, configuration, angles, shown, chosen, scheme]);
  const at = (event: PointerEvent<HTMLElement>) => {
    const { left, top } = event.currentTarget.getBoundingClientRect();
    return [event.clientX - left, event.clientY - top] as const;
  };
  const figures = standing?.figures ?? NOBODY;
  return (
    <div className={classes.picture} data-drawn={standing === null ? "nothing" : "skin"}>
      <div className={classes.sides}>
        <CameraSides onLook={(from) => drawing?.showBody(from)} />
        <button
          type="button"
          className={classes.plainButton}
          disabled={chosen === null}
          onClick={() => drawing?.showJoint()}
        >
          {t("avatars.picture.joint")}
        </button>
      </div>
      {drawingState === "flat" ? (
        <div className={classes.flat}>
          <Notice tone="warn" title={texts.flat} remedy={texts.flatRemedy} />
          <SideView figures={figures} time={seconds(0)} label={t("avatars.picture")} />
        </div>
      ) : (
        <div
          ref={root}
          className={classes.canvas}
          role="img"
          aria-label={t("avatars.picture.label")}
          data-way={drawingState}
          // In the capture phase: what grabs a needle does not turn the camera.
          onPointerDownCapture={(event) => {
            const needle = drawing?.needleAt(...at(event)) ?? null;
            if (needle === null) return;
            event.stopPropagation();
            event.currentTarget.setPointerCapture(event.pointerId);
            grabbed.current = needle;
            onChoose(needle.axis);
          }}
          onPointerMoveCapture={(event) => {
            const needle = grabbed.current;
            if (needle === null) return;
            event.stopPropagation();
            const angle = drawing?.angleUnder(needle, ...at(event)) ?? null;
            if (angle !== null) {
              onAngle(needle.axis, Math.min(Math.max(angle, needle.lowDeg), needle.highDeg));
            }
          }}
          onPointerUpCapture={() => {
            grabbed.current = null;
          }}
        />
      )}
      {notice}
    </div>
  );
}

async function loadScene() {
  const { JointScene } = await import("./jointScene");
  return (canvas: HTMLCanvasElement) => new JointScene(canvas);
}

/** A figure that stands with its hips where the model has them, and whose pose is set in place. */
function standingBody(model: BodyModel) {
  const { binding } = model;
  const hipsM = (binding.joints_m[0] ?? [0, 1, 0]) as unknown as Vector;
  const pose = livePose(JOINTS, PARENTS);
  const parts = new Parts(binding, 1, pose);
  const motion = {
    kind: "skeleton",
    names: binding.parts,
    parents: binding.parents,
    frames: 1,
    rateHz: 30,
    recordedRateHz: 30,
    positions: new Float32Array(binding.joints_m.flat()),
  } as const;
  const figure: Figure = {
    key: "body",
    motion,
    tone: "solid",
    roles: rolesFrom(motion.names, AVATAR_MAP),
    worn: { model, statureM: binding.stature_m, pose },
  };
  return {
    model,
    parts,
    figures: [figure] as const,
    pose: (configuration: AvatarFile, angles: Angles): void => {
      pose.values.set(poseValues(configuration, angles, hipsM));
      parts.place(pose.values);
    },
  };
}

interface JointAnglesProps {
  readonly configuration: AvatarFile;
  readonly chosen: string | null;
  readonly angles: Angles;
  readonly onAngle: (axis: string, angleDeg: number) => void;
}

/** The angles of the chosen joint, to look at: they are no part of the configuration. */
function JointAngles(props: JointAnglesProps): JSX.Element {
  const { configuration, chosen, angles, onAngle } = props;
  const texts = useTexts();
  const { t, language } = texts;
  const own = Object.keys(configuration.axes).filter(
    (axis) => chosen !== null && partOf(axis) === partOf(chosen),
  );
  if (own.length === 0) return <p className={classes.soft}>{t("avatars.angles.none")}</p>;
  return (
    <fieldset className={classes.angles}>
      <legend>{t("avatars.angles")}</legend>
      {own.map((axis) => {
        const { low_deg, high_deg } = configuration.axes[axis] ?? { low_deg: 0, high_deg: 0 };
        const angle = angleOf(configuration, angles, axis);
        const isHeld = low_deg === high_deg || configuration.held_deg[axis] !== undefined;
        return (
          <label key={axis} className={classes.angle} data-chosen={axis === chosen || undefined}>
            <span className={classes.letter} data-letter={axis.slice(-1)}>
              {axis.slice(-1)}
            </span>
            <span className={classes.angleName}>{axisName(texts, axis)}</span>
            <input
              type="range"
              min={low_deg}
              max={high_deg}
              step={1}
              value={angle}
              disabled={isHeld}
              aria-valuetext={`${decimals(angle, language, 0)}°`}
              onChange={(event) => onAngle(axis, event.currentTarget.valueAsNumber)}
            />
            <span className={`${classes.reading} numbers`}>{decimals(angle, language, 0)}°</span>
          </label>
        );
      })}
    </fieldset>
  );
}
