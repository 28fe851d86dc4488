/**
 * Bodies, markers and trackers in 3-D over a floor with a scale, whatever their source.
 *
 * Drawn in 3-D if the browser can, otherwise from the side with a notice. The camera is moved by
 * mouse
 * or touch, or by the page's own buttons through `StageHandle`.
 */
import { Center, Loader, useComputedColorScheme } from "@mantine/core";
import { type JSX, type Ref, useEffect, useImperativeHandle, useRef, useState } from "react";
import { Notice } from "../ui/Notice";
import type { Seconds } from "../units";
import {
  type Block,
  type BlockTones,
  type CameraMode,
  type CameraSide,
  type Figure,
  paletteOf,
} from "./figure";
import { SideView } from "./SideView";
import classes from "./Stage.module.css";
import type { Pointed } from "./scene";
import { useDrawing } from "./useDrawing";

export interface StageTexts {
  readonly loading: string;
  readonly flat: string;
  readonly flatRemedy: string;
  /** The text for the size of the floor's squares, given in metres. */
  readonly squares: (metres: number) => string;
}

export interface StageHandle {
  readonly placeCamera: (from: CameraSide) => void;
  readonly zoom: (factor: number) => void;
}

interface StageProps {
  readonly figures: readonly Figure[];
  readonly time: Seconds;
  readonly mode: CameraMode;
  readonly label: string;
  readonly texts: StageTexts;
  readonly handle?: Ref<StageHandle>;
  /** From where the camera looks when the stage opens, and at each new floor. */
  readonly firstSide?: CameraSide;
  /** Must be the same array while the blocks are the same. */
  readonly blocks?: readonly Block[];
  /**
   * Figures of other stages for comparison, which share the floor's size; the same array while they
   * are the same.
   */
  readonly comparedFigures?: readonly Figure[];
  /** Must be the same map while the tones are the same. */
  readonly tones?: BlockTones;
}

const NO_BLOCKS: readonly Block[] = [];
const NOBODY: readonly Figure[] = [];
const ALL_PLAIN: BlockTones = new Map();

export function Stage(props: StageProps): JSX.Element {
  const { figures, time, mode, label, texts, handle } = props;
  const { blocks = NO_BLOCKS, comparedFigures = NOBODY, tones = ALL_PLAIN } = props;
  const { firstSide = "corner" } = props;
  const root = useRef<HTMLDivElement>(null);
  const { drawingState, stage, step } = useStage3d(root, {
    figures,
    time,
    mode,
    blocks,
    comparedFigures,
    tones,
    firstSide,
  });
  const [pointed, setPointed] = useState<Pointed | null>(null);
  useImperativeHandle(handle, () => ({
    placeCamera: (from) => stage?.placeCamera(from),
    zoom: (factor) => stage?.zoom(factor),
  }));
  if (drawingState === "flat") {
    return (
      <div className={classes.stage} data-way={drawingState}>
        <div className={classes.flat}>
          <Notice tone="warn" title={texts.flat} remedy={texts.flatRemedy} />
          <SideView figures={figures} time={time} label={label} />
        </div>
      </div>
    );
  }
  return (
    <div className={classes.stage} data-way={drawingState}>
      {/* The label describes the picture; the buttons around it move the camera. */}
      <div
        ref={root}
        className={classes.canvas}
        role="img"
        aria-label={label}
        onPointerMove={(event) => {
          const { left, top } = event.currentTarget.getBoundingClientRect();
          const near = stage?.nearest(event.clientX - left, event.clientY - top) ?? null;
          setPointed((before) => (before?.name === near?.name && near === null ? before : near));
        }}
        onPointerLeave={() => setPointed(null)}
      />
      {drawingState === "loading" && (
        <Center pos="absolute" inset={0}>
          <Loader role="status" aria-label={texts.loading} />
        </Center>
      )}
      {pointed !== null && (
        <span className={classes.name} style={{ left: pointed.x, top: pointed.y }}>
          {pointed.name}
        </span>
      )}
      {drawingState === "space" && <span className={classes.scale}>{texts.squares(step)}</span>}
    </div>
  );
}

interface StageContent {
  readonly figures: readonly Figure[];
  readonly time: Seconds;
  readonly mode: CameraMode;
  readonly blocks: readonly Block[];
  readonly comparedFigures: readonly Figure[];
  readonly tones: BlockTones;
  readonly firstSide: CameraSide;
}

function useStage3d(root: React.RefObject<HTMLDivElement | null>, shown: StageContent) {
  const scheme = useComputedColorScheme("light");
  const { drawingState, drawing: stage } = useDrawing(root, loadStage);
  const { figures, blocks, comparedFigures, tones, mode, time, firstSide } = shown;
  const newest = useRef(tones);
  newest.current = tones;
  const [step, setStep] = useState(1);
  useEffect(() => stage?.setFirstSide(firstSide), [stage, firstSide]);
  // Set the time first: figures on a new floor are framed as they are at that moment.
  useEffect(() => stage?.setMode(mode), [stage, mode]);
  useEffect(() => stage?.show(time), [stage, time]);
  // Read the colours again when the colour scheme changes.
  useEffect(() => {
    if (stage === null || root.current === null || scheme === undefined) return;
    stage.setFigures(figures, paletteOf(root.current), { blocks, comparedFigures });
    stage.light(newest.current);
    setStep(stage.step);
  }, [root, stage, figures, blocks, comparedFigures, scheme]);
  useEffect(() => stage?.light(tones), [stage, tones]);
  return { drawingState, stage, step };
}

async function loadStage() {
  const { Stage3d } = await import("./scene");
  return (canvas: HTMLCanvasElement) => new Stage3d(canvas);
}
