/** The stage with its camera and its transport controls. */
import { ActionIcon, SegmentedControl, Tooltip } from "@mantine/core";
import {
  type CameraMode,
  type CameraSide,
  type Figure,
  LEFT_COLOUR,
  RIGHT_COLOUR,
} from "@shared/stage/figure";
import { Legend } from "@shared/stage/Legend";
import { durationOf } from "@shared/stage/motion";
import { hasGaps } from "@shared/stage/placing";
import { Stage, type StageHandle } from "@shared/stage/Stage";
import { Transport } from "@shared/stage/Transport";
import { usePlayback } from "@shared/stage/usePlayback";
import { Icon } from "@shared/ui/Icon";
import { seconds } from "@shared/units";
import { type JSX, type ReactNode, type RefObject, useMemo, useRef, useState } from "react";
import { useTexts } from "../i18n";
import { useStageTexts, useTransportTexts } from "./useStageTexts";
import classes from "./Viewer.module.css";

interface ViewerProps {
  readonly figures: readonly Figure[];
  readonly title: string;
  /** What is shown over the picture. */
  readonly children?: ReactNode;
}

const CAMERAS: readonly CameraMode[] = ["orbit", "follow", "eyes"];
const CAMERA_SIDES: readonly CameraSide[] = ["corner", "front", "side", "top"];

export function Viewer({ figures, title, children }: ViewerProps): JSX.Element {
  const { t } = useTexts();
  const stageTexts = useStageTexts();
  const transportTexts = useTransportTexts();
  const [mode, setMode] = useState<CameraMode>("orbit");
  const stage = useRef<StageHandle>(null);
  const motion = figures[0]?.motion;
  const playback = usePlayback(motion === undefined ? seconds(0) : durationOf(motion));
  const hasEyes = figures[0]?.roles?.head != null && figures[0].roles.leftHip !== null;
  const what = t("capture.picture.points", { count: motion?.names.length ?? 0 });
  return (
    <div className={classes.viewer}>
      <CameraBar
        mode={hasEyes || mode !== "eyes" ? mode : "orbit"}
        hasEyes={hasEyes}
        stage={stage}
        onMode={setMode}
      />
      <div
        className={classes.stage}
        data-drawn={figures[0]?.worn === undefined ? "skeleton" : "skin"}
      >
        <Stage
          handle={stage}
          figures={figures}
          time={playback.time}
          mode={hasEyes || mode !== "eyes" ? mode : "orbit"}
          label={t("capture.picture", { title, what })}
          texts={stageTexts}
        />
        {children}
        <StageLegend figures={figures} />
      </div>
      {motion !== undefined && (
        <Transport motion={motion} playback={playback} texts={transportTexts} />
      )}
    </div>
  );
}

interface CameraBarProps {
  readonly mode: CameraMode;
  readonly hasEyes: boolean;
  readonly stage: RefObject<StageHandle | null>;
  readonly onMode: (mode: CameraMode) => void;
}

/** The camera controls of one stage, or of several that are moved together. */
export function CameraBar({ mode, hasEyes, stage, onMode }: CameraBarProps): JSX.Element {
  const { t } = useTexts();
  const zooms = [
    { name: t("stage.nearer"), icon: "add", factor: 0.8 },
    { name: t("stage.farther"), icon: "minus", factor: 1.25 },
  ] as const;
  return (
    <div className={classes.bar}>
      <SegmentedControl
        size="xs"
        aria-label={t("stage.camera")}
        value={mode}
        onChange={(value) => onMode(value as CameraMode)}
        data={CAMERAS.map((value) => ({
          value,
          label: t(`stage.camera.${value}`),
          disabled: value === "eyes" && !hasEyes,
        }))}
      />
      <fieldset className={classes.cameraSides} disabled={mode === "eyes"}>
        <legend className="visually-hidden">{t("stage.look")}</legend>
        {CAMERA_SIDES.map((from) => (
          <button
            key={from}
            type="button"
            className={classes.cameraSide}
            onClick={() => stage.current?.placeCamera(from)}
          >
            {t(`stage.look.${from}`)}
          </button>
        ))}
        {zooms.map(({ name, icon, factor }) => (
          <Tooltip key={icon} label={name}>
            <ActionIcon
              variant="default"
              size="md"
              aria-label={name}
              onClick={() => stage.current?.zoom(factor)}
            >
              <Icon name={icon} size={15} />
            </ActionIcon>
          </Tooltip>
        ))}
      </fieldset>
    </div>
  );
}

function StageLegend({ figures }: { readonly figures: readonly Figure[] }): JSX.Element | null {
  const { t } = useTexts();
  const hasSides = figures.some(
    ({ roles, tone, worn }) =>
      tone === "solid" && worn === undefined && roles !== undefined && roles.left.size > 0,
  );
  const unseen = useMemo(() => figures.some(({ motion }) => hasGaps(motion)), [figures]);
  const entries = [
    ...(hasSides
      ? [
          { name: t("capture.legend.left"), colour: LEFT_COLOUR },
          { name: t("capture.legend.right"), colour: RIGHT_COLOUR },
        ]
      : []),
    ...(unseen ? [{ name: t("capture.legend.unseen"), colour: "var(--warn-line)" }] : []),
    ...(figures.some(({ tone }) => tone === "ghost")
      ? [{ name: t("capture.legend.source"), colour: "var(--line-strong)" }]
      : []),
  ];
  if (entries.length === 0) return null;
  return <Legend entries={entries} />;
}
