/** The scene from above, in metres: obstacles, places, the path's points and walks along it. */
import type { Point, Prediction, Scene } from "@shared/api/walking";
import { number } from "@shared/format";
import {
  type Dispatch,
  type JSX,
  type KeyboardEvent,
  type PointerEvent,
  useMemo,
  useRef,
  useState,
} from "react";
import { useTexts } from "../i18n";
import type { PathChange } from "./drawnPath";
import { lineOf, type Plan, planOf, WIDTH } from "./plan";
import { SceneFloor } from "./SceneFloor";
import classes from "./Walking.module.css";

interface SceneDrawingProps {
  readonly scene: Scene;
  readonly points: readonly Point[];
  /** Whether the path is planned: then a line between the points is none. */
  readonly planned: boolean;
  readonly plannedPath: readonly Point[] | null;
  readonly walkers: Prediction["walkers"];
  readonly synthetic: boolean;
  /** The time at which each walker is shown, s. */
  readonly atS: number;
  readonly onChange: Dispatch<PathChange>;
}

interface Drag {
  readonly at: number;
  readonly point: Point;
}

const STEP_M = 0.1;
const KEYS: Readonly<Record<string, Point>> = {
  ArrowLeft: [-STEP_M, 0],
  ArrowRight: [STEP_M, 0],
  ArrowUp: [0, STEP_M],
  ArrowDown: [0, -STEP_M],
};

export function SceneDrawing(props: SceneDrawingProps): JSX.Element {
  const { scene, points, planned, plannedPath, walkers, synthetic, atS, onChange } = props;
  const { t } = useTexts();
  const plan = useMemo(() => planOf(scene.bounds_m), [scene]);
  const root = useRef<SVGSVGElement>(null);
  const [drag, setDrag] = useState<Drag | null>(null);
  const shown = points.map((point, at) => (drag?.at === at ? drag.point : point));
  const floor = (event: PointerEvent): Point => {
    const box = root.current?.getBoundingClientRect();
    if (box === undefined || box.width === 0) return [0, 0];
    const px = WIDTH / box.width;
    return plan.floor((event.clientX - box.left) * px, (event.clientY - box.top) * px);
  };
  const drop = () => {
    if (drag !== null) onChange({ do: "move", at: drag.at, point: drag.point });
    setDrag(null);
  };
  return (
    <div className={classes.picture}>
      {/* biome-ignore lint/a11y/useSemanticElements: a picture is not a fieldset; each of its points
         is a button. */}
      <svg
        ref={root}
        viewBox={`0 0 ${WIDTH} ${plan.height}`}
        aria-label={t("walking.picture", { scene: scene.title })}
        role="group"
        onPointerDown={(event) => {
          if (event.button === 0) onChange({ do: "add", point: floor(event) });
        }}
        onPointerMove={(event) => drag !== null && setDrag({ ...drag, point: floor(event) })}
        onPointerUp={drop}
        onPointerLeave={drop}
      >
        <SceneFloor scene={scene} plan={plan} />
        {walkers.map(({ xy_m, duration_s, vector }) => (
          <polyline
            key={`${duration_s} ${vector.join(" ")}`}
            className={classes.walker}
            points={lineOf(plan, xy_m)}
          />
        ))}
        <polyline
          className={classes.plannedPath}
          points={lineOf(plan, (drag === null ? plannedPath : null) ?? (planned ? [] : shown))}
        />
        {walkers.map(({ xy_m, step_s, duration_s, vector }) => {
          const [x, y] = xy_m[Math.min(xy_m.length - 1, Math.round(atS / step_s))] ?? [0, 0];
          return (
            <circle
              key={`${duration_s} ${vector.join(" ")}`}
              className={classes.dot}
              cx={plan.x(x)}
              cy={plan.y(y)}
              r={3.5}
            />
          );
        })}
        {synthetic && walkers.length > 0 && (
          <text className={classes.watermark} x={WIDTH / 2} y={plan.height / 2}>
            {t("walking.watermark")}
          </text>
        )}
        {shown.map((point, at) => (
          <PathPoint
            // biome-ignore lint/suspicious/noArrayIndexKey: a point is identified by its position in the path.
            key={at}
            at={at}
            point={point}
            plan={plan}
            onGrab={() => setDrag({ at, point })}
            onChange={onChange}
          />
        ))}
      </svg>
    </div>
  );
}

interface PathPointProps {
  readonly at: number;
  readonly point: Point;
  readonly plan: Plan;
  readonly onGrab: () => void;
  readonly onChange: Dispatch<PathChange>;
}

function PathPoint({ at, point, plan, onGrab, onChange }: PathPointProps): JSX.Element {
  const { t, language } = useTexts();
  const [x, y] = point;
  const onKeyDown = (event: KeyboardEvent) => {
    const step = KEYS[event.key];
    if (step !== undefined) {
      onChange({ do: "move", at, point: [x + step[0], y + step[1]] });
    } else if (event.key === "Delete" || event.key === "Backspace") {
      onChange({ do: "remove", at });
    } else return;
    event.preventDefault();
  };
  return (
    // biome-ignore lint/a11y/useSemanticElements: there are no buttons within a picture.
    <g
      className={classes.point}
      role="button"
      tabIndex={0}
      aria-label={t("walking.point.at", {
        at: at + 1,
        x: number(x, language),
        y: number(y, language),
      })}
      onPointerDown={(event) => {
        event.stopPropagation();
        onGrab();
      }}
      onKeyDown={onKeyDown}
    >
      <circle cx={plan.x(x)} cy={plan.y(y)} r={11} />
      <text x={plan.x(x)} y={plan.y(y)} aria-hidden>
        {at + 1}
      </text>
    </g>
  );
}
