/** Draw a layout on a canvas. */
import type { Ink, Layout, Mark, Rectangle } from "./layout";
import type { Measure } from "./wrap";

const FAMILY = 'system-ui, "Segoe UI", Roboto, "Noto Sans", sans-serif';

/**
 * Light text on a calm, dark ground: a bright surface in a headset glares and flickers. Contrast to
 * the ground (WCAG 2.2): plain 13.6, soft 7.1, accent 8.6, problem 8.0; each sign has a shape as
 * well.
 */
const COLOURS = {
  ground: "#1b2325",
  edge: "#35424a",
  row: "#273236",
  rowLine: "#46555b",
  chosen: "#123c42",
  primary: "#7cced5",
  field: "#11181a",
  track: "#3a474c",
  done: "#7cced5",
} as const;

export const INKS: Readonly<Record<Ink, string>> = {
  plain: "#eef3f3",
  soft: "#aebcbd",
  accent: "#8fdce2",
  onAccent: "#062327",
  problem: "#f7bf74",
};

const fontOf = (sizeDmm: number, isBold: boolean, pxPerDmm: number): string =>
  `${isBold ? 600 : 400} ${sizeDmm * pxPerDmm}px ${FAMILY}`;

/** Measure with the font that is drawn. */
export function canvasMeasure(context: CanvasRenderingContext2D): Measure {
  const known = new Map<string, number>();
  return (text, sizeDmm, isBold) => {
    const key = `${isBold ? "b" : "r"}${text}`;
    let perDmm = known.get(key);
    if (perDmm === undefined) {
      // At a large size, so that hinting does not round what is drawn smaller.
      context.font = fontOf(100, isBold, 1);
      perDmm = context.measureText(text).width / 100;
      known.set(key, perDmm);
      if (known.size > 4000) known.clear();
    }
    return perDmm * sizeDmm;
  };
}

/** Draw a layout over the whole canvas. */
export function paint(context: CanvasRenderingContext2D, layout: Layout): void {
  const { width, height } = context.canvas;
  const scale = width / layout.widthDmm;
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, width, height);
  context.setTransform(scale, 0, 0, scale, 0, 0);
  const ground = { x: 1, y: 1, width: layout.widthDmm - 2, height: layout.heightDmm - 2 };
  box(context, ground, 28, COLOURS.ground, COLOURS.edge);
  for (const mark of layout.marks) draw(context, mark);
}

/** Draw a few short lines on a rounded ground: the first one large, the others small. */
export function paintLabel(context: CanvasRenderingContext2D, lines: readonly string[]): void {
  const { width, height } = context.canvas;
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.clearRect(0, 0, width, height);
  box(
    context,
    { x: 2, y: 2, width: width - 4, height: height - 4 },
    height / 5,
    COLOURS.ground,
    null,
  );
  context.textAlign = "center";
  context.textBaseline = "middle";
  const pitch = height / (lines.length + 0.6);
  for (const [at, line] of lines.entries()) {
    context.font = fontOf(pitch * (at === 0 ? 0.66 : 0.5), at === 0, 1);
    context.fillStyle = at === 0 ? INKS.plain : INKS.soft;
    context.fillText(line, width / 2, pitch * (at + 0.8), width * 0.92);
  }
}

function draw(context: CanvasRenderingContext2D, mark: Mark): void {
  switch (mark.kind) {
    case "box": {
      const line = { row: COLOURS.rowLine, chosen: COLOURS.done };
      const fill =
        mark.fill === null ? null : mark.fill === "problem" ? INKS.problem : COLOURS[mark.fill];
      box(context, mark.at, mark.radius, fill, mark.line === null ? null : line[mark.line]);
      return;
    }
    case "text":
      context.font = fontOf(mark.font.sizeDmm, mark.font.isBold, 1);
      context.fillStyle = INKS[mark.ink];
      context.textAlign = mark.align;
      context.textBaseline = "middle";
      context.fillText(mark.text, mark.x, mark.y);
      return;
    case "tick":
      tick(context, mark.x, mark.y, mark.size);
      return;
    case "alert":
      alert(context, mark.x, mark.y, mark.size);
      return;
  }
}

function box(
  context: CanvasRenderingContext2D,
  { x, y, width, height }: Rectangle,
  radius: number,
  fill: string | null,
  line: string | null,
): void {
  context.beginPath();
  context.roundRect(x, y, width, height, radius);
  if (fill !== null) {
    context.fillStyle = fill;
    context.fill();
  }
  if (line === null) return;
  context.strokeStyle = line;
  context.lineWidth = 2;
  context.stroke();
}

function tick(context: CanvasRenderingContext2D, x: number, y: number, size: number): void {
  context.beginPath();
  context.moveTo(x - size / 2, y);
  context.lineTo(x - size / 8, y + size / 2.8);
  context.lineTo(x + size / 2, y - size / 2.8);
  context.strokeStyle = INKS.accent;
  context.lineWidth = 5;
  context.lineCap = "round";
  context.lineJoin = "round";
  context.stroke();
}

/** A triangle with an exclamation mark. */
function alert(context: CanvasRenderingContext2D, x: number, y: number, size: number): void {
  context.beginPath();
  context.moveTo(x, y - size / 2);
  context.lineTo(x + size * 0.56, y + size / 2);
  context.lineTo(x - size * 0.56, y + size / 2);
  context.closePath();
  context.fillStyle = INKS.problem;
  context.fill();
  context.fillStyle = COLOURS.ground;
  context.fillRect(x - 1.6, y - size * 0.16, 3.2, size * 0.34);
  context.fillRect(x - 1.6, y + size * 0.27, 3.2, 3.2);
}
