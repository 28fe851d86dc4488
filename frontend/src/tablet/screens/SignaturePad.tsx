/** A surface to sign with finger, pen or mouse. People who cannot draw type their name instead. */
import { Button } from "@mantine/core";
import { type JSX, type PointerEvent, useRef } from "react";
import { useTexts } from "../i18n";
import classes from "./Consent.module.css";

const WIDTH = 600;
const HEIGHT = 200;
/** Points nearer than this add nothing visible, units of the surface. */
const STEP = 2;
const LONGEST = 39_000;

interface SignaturePadProps {
  readonly path: string;
  readonly onChange: (path: string) => void;
}

type Point = readonly [x: number, y: number];

export function SignaturePad({ path, onChange }: SignaturePadProps): JSX.Element {
  const { t } = useTexts();
  const drawn = useRef(path);
  const last = useRef<Point | null>(null);
  // The stored signature arrives a moment after the page.
  if (last.current === null) drawn.current = path;
  const put = (next: string) => {
    if (next.length > LONGEST) return;
    drawn.current = next;
    onChange(next);
  };
  const begin = (event: PointerEvent<SVGSVGElement>) => {
    if (!event.isPrimary || event.button !== 0) return;
    event.currentTarget.setPointerCapture(event.pointerId);
    last.current = pointOf(event);
    put(`${drawn.current}M${last.current.join(" ")}`);
  };
  const go = (event: PointerEvent<SVGSVGElement>) => {
    if (last.current === null || !event.isPrimary) return;
    const point = pointOf(event);
    if (Math.hypot(point[0] - last.current[0], point[1] - last.current[1]) < STEP) return;
    last.current = point;
    put(`${drawn.current}L${point.join(" ")}`);
  };
  const end = () => {
    last.current = null;
  };
  return (
    <div className={classes.pad}>
      <svg
        className={classes.surface}
        viewBox={`0 0 ${WIDTH} ${HEIGHT}`}
        role="img"
        aria-label={t("consent.surface")}
        onPointerDown={begin}
        onPointerMove={go}
        onPointerUp={end}
        onPointerCancel={end}
      >
        <line x1="30" y1="160" x2="570" y2="160" />
        <path d={path} />
      </svg>
      <Button
        variant="subtle"
        color="gray"
        size="sm"
        disabled={path === ""}
        onClick={() => put("")}
      >
        {t("consent.clear")}
      </Button>
    </div>
  );
}

/** The position of the pointer on the surface, to a tenth of a unit. */
function pointOf(event: PointerEvent<SVGSVGElement>): Point {
  const box = event.currentTarget.getBoundingClientRect();
  const on = (share: number, size: number) =>
    Math.round(10 * Math.min(size, Math.max(0, share * size))) / 10;
  return [
    on((event.clientX - box.left) / box.width, WIDTH),
    on((event.clientY - box.top) / box.height, HEIGHT),
  ];
}
