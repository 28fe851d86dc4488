/** A movement without WebGL: lines on a plane, seen from the side with the largest extent. */
import { type JSX, useMemo } from "react";
import type { Seconds } from "../units";
import { type Figure, LEFT_COLOUR, RIGHT_COLOUR } from "./figure";
import { floorPlan } from "./floor";
import { placing } from "./placing";
import classes from "./Stage.module.css";

interface SideViewProps {
  readonly figures: readonly Figure[];
  readonly time: Seconds;
  readonly label: string;
}

export function SideView({ figures, time, label }: SideViewProps): JSX.Element {
  const plan = useMemo(() => floorPlan(figures), [figures]);
  const bodies = useMemo(() => figures.map(placing), [figures]);
  const axis = plan.max[0] - plan.min[0] > plan.max[1] - plan.min[1] ? 0 : 1;
  const [from, to] = [plan.min[axis], plan.max[axis]];
  const lines = Array.from({ length: Math.round((to - from) / plan.step) + 1 }, (_, n) =>
    Number((from + n * plan.step).toPrecision(6)),
  );
  const height = 1.1 * Math.max(plan.box.max[1], 0.1 * plan.step);
  const unit = (to - from) / 100;
  for (const body of bodies) body.place(time);
  return (
    <svg
      className={classes.side}
      role="img"
      aria-label={label}
      viewBox={`${from} ${-height} ${to - from} ${height + 5 * unit}`}
      preserveAspectRatio="xMidYMid meet"
    >
      <line x1={from} x2={to} y1={0} y2={0} stroke="var(--line-strong)" strokeWidth={0.3 * unit} />
      {lines.map((value) => (
        <g key={value}>
          <line
            x1={value}
            x2={value}
            y1={0}
            y2={unit}
            stroke="var(--line-strong)"
            strokeWidth={0.2 * unit}
          />
          <text
            x={value}
            y={3.8 * unit}
            fontSize={2.2 * unit}
            textAnchor="middle"
            fill="var(--ink-soft)"
          >
            {value} m
          </text>
        </g>
      ))}
      {bodies.map((body) => (
        <Lines key={body.figure.key} body={body} axis={axis} unit={unit} />
      ))}
    </svg>
  );
}

interface LinesProps {
  readonly body: ReturnType<typeof placing>;
  readonly axis: 0 | 1;
  readonly unit: number;
}

function Lines({ body, axis, unit }: LinesProps): JSX.Element {
  const { figure, placed, seen } = body;
  const at = (point: number): readonly [number, number] => [
    placed[3 * point + 2 * axis] ?? Number.NaN,
    -(placed[3 * point + 1] ?? Number.NaN),
  ];
  const colour = (point: number): string => {
    if (figure.tone === "ghost") return "var(--line-strong)";
    if (figure.roles?.left.has(point)) return LEFT_COLOUR;
    return figure.roles?.right.has(point) ? RIGHT_COLOUR : "var(--accent)";
  };
  const known = (point: number) => Number.isFinite(at(point)[0]);
  return (
    <g opacity={figure.tone === "ghost" ? 0.5 : 1}>
      {figure.motion.parents.map((parent, point) =>
        parent < 0 || !known(point) || !known(parent) ? null : (
          <line
            key={figure.motion.names[point]}
            x1={at(parent)[0]}
            y1={at(parent)[1]}
            x2={at(point)[0]}
            y2={at(point)[1]}
            stroke={colour(point)}
            strokeWidth={0.7 * unit}
            strokeLinecap="round"
            {...(seen[point] === 1 && seen[parent] === 1 ? {} : { strokeDasharray: `${unit}` })}
          />
        ),
      )}
      {figure.motion.names.map((name, point) =>
        known(point) ? (
          <circle
            key={name}
            cx={at(point)[0]}
            cy={at(point)[1]}
            r={figure.highlighted === point ? 1.6 * unit : 0.6 * unit}
            fill={seen[point] === 1 ? colour(point) : "none"}
            stroke={seen[point] === 1 ? "none" : "var(--warn)"}
            strokeWidth={0.3 * unit}
          >
            <title>{name}</title>
          </circle>
        ) : null,
      )}
    </g>
  );
}
