/** One phase in 3-D; its boxes light up as they were touched. */
import { Center, Loader } from "@mantine/core";
import { type BlockTones, type CameraMode, LEFT_COLOUR, RIGHT_COLOUR } from "@shared/stage/figure";
import { Legend } from "@shared/stage/Legend";
import { durationOf } from "@shared/stage/motion";
import { Stage, type StageHandle } from "@shared/stage/Stage";
import { type Seconds, seconds } from "@shared/units";
import { type JSX, type Ref, useRef } from "react";
import { MarksLegend } from "../avatarChanges/MarksLegend";
import { BodyNotice } from "../bodyView/BodyNotice";
import { useDrawnAs } from "../bodyView/DrawnAs";
import { useBody } from "../bodyView/useBody";
import { useStageTexts } from "../captures/useStageTexts";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { EmptyState } from "../ui/EmptyState";
import { tonesAt } from "./events";
import classes from "./Replay.module.css";
import { type Lane, marksAt, useBlocksOf, useFiguresOf } from "./useLane";

interface LaneStageProps {
  readonly lane: Lane;
  /** The phase it is compared with: both are shown at the same scale. */
  readonly other: Lane | null;
  readonly time: Seconds;
  readonly mode: CameraMode;
  readonly ghost: boolean;
  readonly boxes: boolean;
  readonly handle: Ref<StageHandle> | undefined;
}

const NONE = [] as const;
const NOBODY = { movement: null, replay: null } as const;

export function LaneStage(props: LaneStageProps): JSX.Element {
  const { lane, other, time, mode, ghost, boxes, handle } = props;
  const { t } = useTexts();
  const texts = useStageTexts();
  const [drawn] = useDrawnAs();
  const body = useBody(drawn === "skin" ? (lane.replay.humanoid ?? null) : null);
  const figures = useFiguresOf(lane, ghost, body.model);
  const otherFigures = useFiguresOf(other ?? NOBODY, false, null);
  const blocks = useBlocksOf(lane);
  const tones = useStableMap(tonesAt(lane.replay, time));
  const isGap = lane.movement?.gaps.some(([begin, end]) => begin < time && time < end) ?? false;
  const motion = figures[0]?.motion;
  return (
    <section className={classes.lane} aria-label={lane.label}>
      {other !== null && <h2 className={classes.laneName}>{lane.label}</h2>}
      {motion === undefined ? (
        <NoMovement lane={lane} />
      ) : (
        <div
          className={classes.stage}
          data-drawn={figures[0]?.worn === undefined ? "skeleton" : "skin"}
        >
          <Stage
            {...(handle === undefined ? {} : { handle })}
            figures={figures}
            blocks={boxes ? blocks : NONE}
            comparedFigures={otherFigures}
            tones={tones}
            time={seconds(Math.min(time, durationOf(motion)))}
            mode={mode}
            label={t("replay.picture", { phase: lane.label, time: `${time.toFixed(1)} s` })}
            texts={texts}
          />
          {isGap && <span className={classes.gap}>{t("replay.nothing")}</span>}
          <BodyNotice body={body} instead />
          <span className={classes.marks}>
            <MarksLegend marks={marksAt(lane.replay.avatar_settings, time)} />
          </span>
          <StageLegend
            ghost={figures.length > 1 && mode !== "eyes"}
            sides={figures[0]?.worn === undefined}
          />
        </div>
      )}
    </section>
  );
}

function NoMovement({ lane }: { readonly lane: Lane }): JSX.Element {
  const { t } = useTexts();
  if (lane.error !== null) return <Failure error={lane.error} onRetry={lane.retry} />;
  if (lane.replay.has_movement) {
    return (
      <Center className={classes.stage}>
        <Loader role="status" aria-label={t("stage.loading")} />
      </Center>
    );
  }
  return (
    <div className={classes.unavailable}>
      <EmptyState icon="walk" title={t("replay.noMovement")}>
        {t("replay.noMovement.body")}
      </EmptyState>
    </div>
  );
}

interface StageLegendProps {
  readonly ghost: boolean;
  /** Whether the sides of the figure have colours, as those of a skeleton. */
  readonly sides: boolean;
}

function StageLegend({ ghost, sides }: StageLegendProps): JSX.Element | null {
  const { t } = useTexts();
  if (!ghost && !sides) return null;
  const entries = [
    ...(sides
      ? [
          { name: t("replay.legend.left"), colour: LEFT_COLOUR },
          { name: t("replay.legend.right"), colour: RIGHT_COLOUR },
        ]
      : []),
    ...(ghost ? [{ name: t("replay.legend.participant"), colour: "var(--line-strong)" }] : []),
  ];
  return <Legend entries={entries} />;
}

/** Return the same map while its content is the same, so that nothing is redrawn needlessly. */
function useStableMap(tones: BlockTones): BlockTones {
  const before = useRef(tones);
  const signature = (map: BlockTones) =>
    [...map]
      .map((pair) => pair.join(" "))
      .sort()
      .join(",");
  if (signature(before.current) !== signature(tones)) before.current = tones;
  return before.current;
}
