/** The static parts of a scene: the floor with metres on both axes, obstacles and places. */
import type { Scene } from "@shared/api/walking";
import { number } from "@shared/format";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { lineOf, type Plan, ticks } from "./plan";
import classes from "./Walking.module.css";

interface SceneFloorProps {
  readonly scene: Scene;
  readonly plan: Plan;
}

/** How far beside its place a name begins, and the room that it needs, in the picture's units. */
const BESIDE = 14;
const ROOM = 110;

export function SceneFloor({ scene, plan }: SceneFloorProps): JSX.Element {
  const { t, language } = useTexts();
  const [left, near, right, far] = plan.bounds;
  const [x0, x1, y0, y1] = [plan.x(left), plan.x(right), plan.y(near), plan.y(far)];
  // A name stands beside its place, where neither the number of a point nor an obstacle covers it.
  const isNearEdge = (metres: number) => x1 - plan.x(metres) < ROOM;
  return (
    <g>
      <rect className={classes.floor} x={x0} y={y1} width={x1 - x0} height={y0 - y1} />
      {ticks(left, right, plan.scale).map((metres) => (
        <g key={metres}>
          <line className={classes.grid} x1={plan.x(metres)} x2={plan.x(metres)} y1={y0} y2={y1} />
          <text className={classes.tick} x={plan.x(metres)} y={y0 + 15} textAnchor="middle">
            {number(metres, language)}
          </text>
        </g>
      ))}
      {ticks(near, far, plan.scale).map((metres) => (
        <g key={metres}>
          <line className={classes.grid} x1={x0} x2={x1} y1={plan.y(metres)} y2={plan.y(metres)} />
          <text className={classes.tick} x={x0 - 6} y={plan.y(metres) + 4} textAnchor="end">
            {number(metres, language)}
          </text>
        </g>
      ))}
      <text className={classes.axis} x={(x0 + x1) / 2} y={y0 + 34} textAnchor="middle">
        {t("walking.axis.x")}
      </text>
      <text
        className={classes.axis}
        transform={`translate(${Math.max(13, x0 - 34)} ${(y0 + y1) / 2}) rotate(-90)`}
        textAnchor="middle"
      >
        {t("walking.axis.y")}
      </text>
      {scene.obstacles.map(({ name, corners_m }) => (
        <g key={`${name} ${corners_m[0]?.join(" ")}`}>
          <polygon className={classes.obstacle} points={lineOf(plan, corners_m)} />
          <text
            className={classes.obstacleName}
            x={mean(corners_m.map(([x]) => plan.x(x)))}
            y={mean(corners_m.map(([, y]) => plan.y(y)))}
          >
            {name}
          </text>
        </g>
      ))}
      {Object.entries(scene.places).map(([name, [x, y]]) => (
        <g key={name}>
          <circle className={classes.place} cx={plan.x(x)} cy={plan.y(y)} r={4} />
          <text
            className={classes.placeName}
            x={plan.x(x) + (isNearEdge(x) ? -BESIDE : BESIDE)}
            y={plan.y(y) + 4}
            textAnchor={isNearEdge(x) ? "end" : "start"}
          >
            {name}
          </text>
        </g>
      ))}
    </g>
  );
}

const mean = (values: readonly number[]): number =>
  values.reduce((sum, value) => sum + value, 0) / Math.max(1, values.length);
