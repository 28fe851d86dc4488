/** A picture of the instructions by its name, with a description for screen readers. */
import { isPicture, type PictureName } from "@shared/pictures";
import type { JSX } from "react";
import { Person, reaching, standing, stepping, tPose } from "./Person";
import classes from "./Picture.module.css";

const SCENES: Readonly<Record<PictureName, () => JSX.Element>> = {
  equipment: Equipment,
  t_pose: TPose,
  mirror: Mirror,
  hand_boxes: HandBoxes,
  foot_boxes: FootBoxes,
};

export type PictureKey = `picture.${PictureName}`;

interface PictureProps {
  readonly name: string;
  /** A page's own wording of what a picture shows, which it keeps under these keys. */
  readonly t: (key: PictureKey) => string;
}

export function Picture({ name, t }: PictureProps): JSX.Element | null {
  if (!isPicture(name)) return null;
  const Scene = SCENES[name];
  return (
    <svg
      className={classes.picture}
      viewBox="0 0 480 246"
      role="img"
      aria-label={t(`picture.${name}`)}
    >
      <Scene />
    </svg>
  );
}

const ACCENT = "var(--accent)";
const QUIET = "var(--line-strong, var(--line))";

function Floor(): JSX.Element {
  return <path d="M20 214H460" stroke={QUIET} strokeWidth={3} strokeLinecap="round" />;
}

/** The pictures of the instructions; the accent colour marks what the text is about. */
function Equipment(): JSX.Element {
  const marks = [
    [208, 130],
    [272, 130],
    [240, 112],
    [230, 168],
    [250, 168],
  ] as const;
  return (
    <>
      <Floor />
      <Person posture={standing(240)} />
      <rect x={222} y={20} width={36} height={16} rx={6} fill={ACCENT} />
      {marks.map(([x, y]) => (
        <circle key={`${x} ${y}`} cx={x} cy={y} r={9} fill={ACCENT} />
      ))}
    </>
  );
}

function TPose(): JSX.Element {
  return (
    <>
      <Floor />
      <g style={{ color: ACCENT }} opacity={0.35} transform="translate(6 -4)">
        <Person posture={tPose(240)} />
      </g>
      <Person posture={tPose(240)} />
    </>
  );
}

function Mirror(): JSX.Element {
  return (
    <>
      <Floor />
      <Person posture={standing(130)} />
      <rect
        x={290}
        y={14}
        width={130}
        height={200}
        rx={6}
        fill="none"
        stroke={ACCENT}
        strokeWidth={5}
      />
      <g opacity={0.6} transform="translate(355 62) scale(0.72)">
        <Person posture={standing(0)} />
      </g>
      <path d="M318 34h34" stroke={ACCENT} strokeWidth={7} strokeLinecap="round" />
      <path
        d="m384 34 6 6 11-12"
        stroke={ACCENT}
        strokeWidth={5}
        fill="none"
        strokeLinecap="round"
      />
    </>
  );
}

function HandBoxes(): JSX.Element {
  return (
    <>
      <Floor />
      <Person posture={reaching(96)} />
      {[0, 1, 2, 3].map((box) => (
        <g key={box} transform={`translate(${222 + 58 * box} 50)`}>
          <rect width={48} height={48} rx={3} fill="none" stroke="currentColor" strokeWidth={4} />
          <rect x={12} y={12} width={24} height={24} rx={2} fill={box === 3 ? ACCENT : QUIET} />
          <text x={24} y={76} textAnchor="middle" fontSize={20} fill="currentColor">
            {box + 1}
          </text>
        </g>
      ))}
      <rect x={322} y={10} width={28} height={28} rx={3} fill={ACCENT} />
    </>
  );
}

function FootBoxes(): JSX.Element {
  return (
    <>
      <Floor />
      <rect
        x={24}
        y={208}
        width={60}
        height={8}
        fill="none"
        stroke="currentColor"
        strokeWidth={3}
      />
      <Person posture={stepping(140)} />
      {[0, 1, 2, 3].map((box) => (
        <g key={box} transform={`translate(${178 + 58 * box} 0)`}>
          <path d="M2 190V213H48V190" fill="none" stroke="currentColor" strokeWidth={4} />
          <path
            d="M10 209H40"
            stroke={box === 0 ? ACCENT : QUIET}
            strokeWidth={6}
            strokeLinecap="round"
          />
          <text x={25} y={238} textAnchor="middle" fontSize={20} fill="currentColor">
            {box + 1}
          </text>
        </g>
      ))}
      <rect x={416} y={198} width={40} height={16} rx={3} fill={ACCENT} />
    </>
  );
}
