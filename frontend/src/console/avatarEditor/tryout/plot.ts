/** Draw the last seconds of curves on a canvas: cheap enough to be done for every other picture. */

import { MARK_PX, markPath } from "./markShapes";
import type { Mark } from "./marks";
import { TICK_S } from "./physics/triedBody";
import { scaleOf } from "./scale";
import { type Curve, type Trace, WINDOW_S } from "./traces";

export interface Line {
  readonly trace: Trace;
  readonly curve: Curve;
  readonly colour: string;
  readonly dash: readonly number[];
}

/** What is drawn with the curves. */
export interface Beside {
  /** What was done; `ticks` is how many the curves have had. */
  readonly marks: readonly Mark[];
  readonly ticks: number;
  /** Values between which the curves can be at most; those far from every value are not drawn. */
  readonly limits: readonly { readonly value: number; readonly colour: string }[];
  /** Where a motor was at its limit, the picture is hatched. */
  readonly hatched: readonly Trace[];
}

export interface PlotLook {
  readonly ink: string;
  readonly grid: string;
  readonly font: string;
  /** The scale reaches at least this far from its middle. */
  readonly least: number;
}

const LEFT = 46;
const BOTTOM = 20;
/** Room for the marks. */
const TOP = 16;
/** Height of a line of words. */
const LINE_PX = 13;
const SECONDS = [-5, -4, -3, -2, -1, 0] as const;

export function drawPlot(
  canvas: HTMLCanvasElement,
  lines: readonly Line[],
  beside: Beside,
  look: PlotLook,
): void {
  const ink = canvas.getContext("2d");
  const width = canvas.clientWidth;
  const height = canvas.clientHeight;
  if (ink === null || width === 0 || height === 0) return;
  const ratio = Math.min(window.devicePixelRatio, 2);
  if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
  }
  ink.setTransform(ratio, 0, 0, ratio, 0, 0);
  ink.clearRect(0, 0, width, height);
  const { low, high, marks } = rangeOf(lines, beside.limits, look.least);
  const xOf = (secondsAgo: number) =>
    LEFT + ((width - LEFT - 8) * (WINDOW_S + secondsAgo)) / WINDOW_S;
  const yOf = (value: number) =>
    TOP + ((height - TOP - BOTTOM) * (high - value)) / Math.max(high - low, 1e-9);
  ink.font = `12px ${look.font}`;
  ink.fillStyle = look.ink;
  ink.strokeStyle = look.grid;
  ink.lineWidth = 1;
  ink.setLineDash([]);
  ink.textBaseline = "middle";
  ink.textAlign = "right";
  ink.beginPath();
  const apart = marks.length > 1 ? (height - TOP - BOTTOM) / (marks.length - 1) : height;
  const every = Math.ceil(LINE_PX / apart);
  marks.forEach((mark, at) => {
    ink.moveTo(LEFT, yOf(mark));
    ink.lineTo(width - 8, yOf(mark));
    if (at % every !== 0) return;
    const words = String(mark).replace("-", "−");
    ink.fillText(words, LEFT - 5, yOf(mark));
  });
  ink.stroke();
  ink.textAlign = "center";
  for (const second of SECONDS) {
    const words = second === 0 ? "0 s" : String(second).replace("-", "−");
    ink.fillText(words, Math.min(xOf(second), width - 14), height - 8);
  }
  const area = { left: LEFT, right: width - 8, top: TOP, bottom: height - BOTTOM };
  beside.hatched.forEach((trace, row) => {
    hatch(ink, trace, row, xOf, area, look.ink);
  });
  drawLimits(ink, beside.limits, low, high, yOf, area);
  ink.lineWidth = 1.6;
  for (const line of lines) drawLine(ink, line, xOf, yOf);
  for (const mark of beside.marks) {
    const x = xOf((mark.tick - beside.ticks) * TICK_S);
    if (x >= LEFT) drawMark(ink, mark, x, area, look.ink);
  }
}

interface Area {
  readonly left: number;
  readonly right: number;
  readonly top: number;
  readonly bottom: number;
}

/** Oblique strokes wherever the motor of a body was at its limit; the other body's lean backwards. */
function hatch(
  ink: CanvasRenderingContext2D,
  trace: Trace,
  row: number,
  xOf: (secondsAgo: number) => number,
  { left, right, top, bottom }: Area,
  colour: string,
): void {
  ink.save();
  ink.beginPath();
  let from = -1;
  for (let index = 0; index <= trace.length; index++) {
    const isAt = index < trace.length && trace.isSaturatedAt(index);
    if (isAt && from < 0) from = index;
    if (isAt || from < 0) continue;
    const x = xOf((from - trace.length) * TICK_S);
    const end = xOf((index - trace.length) * TICK_S);
    // At least wide enough to be seen: most begin and end within some ticks.
    const wide = Math.max(end - x, 3);
    ink.rect(end - wide, top, wide, bottom - top);
    from = -1;
  }
  ink.clip();
  ink.globalAlpha = 0.12;
  ink.fillStyle = colour;
  ink.fillRect(left, top, right - left, bottom - top);
  ink.globalAlpha = 0.75;
  ink.strokeStyle = colour;
  ink.lineWidth = 1;
  ink.beginPath();
  const lean = row === 0 ? bottom - top : top - bottom;
  const reach = Math.abs(lean);
  for (let x = left - reach; x < right + reach; x += HATCH_PX) {
    ink.moveTo(x, bottom);
    ink.lineTo(x + lean, top);
  }
  ink.stroke();
  ink.restore();
}

function drawLimits(
  ink: CanvasRenderingContext2D,
  limits: Beside["limits"],
  low: number,
  high: number,
  yOf: (value: number) => number,
  { left, right }: Area,
): void {
  ink.lineWidth = 1.2;
  ink.setLineDash([10, 3, 2, 3]);
  for (const { value, colour } of limits) {
    if (value < low || value > high) continue;
    ink.strokeStyle = colour;
    ink.beginPath();
    ink.moveTo(left, yOf(value));
    ink.lineTo(right, yOf(value));
    ink.stroke();
  }
  ink.setLineDash([]);
}

function drawMark(
  ink: CanvasRenderingContext2D,
  { kind }: Mark,
  x: number,
  { top, bottom }: Area,
  colour: string,
): void {
  ink.strokeStyle = colour;
  ink.fillStyle = colour;
  ink.lineWidth = 1;
  ink.setLineDash([1, 2]);
  ink.beginPath();
  ink.moveTo(x, top);
  ink.lineTo(x, bottom);
  ink.stroke();
  ink.setLineDash([]);
  ink.save();
  ink.translate(x - MARK_PX / 2, 1);
  const { path, isFilled } = markPath(kind);
  const shape = new Path2D(path);
  if (isFilled) ink.fill(shape);
  else {
    ink.lineWidth = 1.8;
    ink.stroke(shape);
  }
  ink.restore();
}

const HATCH_PX = 6;
/** A limit is drawn from the share of it that the curves reach. */
const NEAR_LIMIT = 0.4;

function drawLine(
  ink: CanvasRenderingContext2D,
  { trace, curve, colour, dash }: Line,
  xOf: (secondsAgo: number) => number,
  yOf: (value: number) => number,
): void {
  ink.strokeStyle = colour;
  ink.setLineDash([...dash]);
  ink.beginPath();
  for (let index = 0; index < trace.length; index++) {
    const value = trace.at(curve, index);
    if (Number.isNaN(value)) continue;
    ink.lineTo(xOf((index - trace.length + 1) * TICK_S), yOf(value));
  }
  ink.stroke();
}

function rangeOf(lines: readonly Line[], limits: Beside["limits"], least: number) {
  let low = Number.POSITIVE_INFINITY;
  let high = Number.NEGATIVE_INFINITY;
  for (const { trace, curve } of lines) {
    for (let index = 0; index < trace.length; index++) {
      const value = trace.at(curve, index);
      if (value < low) low = value;
      if (value > high) high = value;
    }
  }
  for (const { value } of limits) {
    if (value > 0 && high >= NEAR_LIMIT * value) high = Math.max(high, value);
    if (value < 0 && low <= NEAR_LIMIT * value) low = Math.min(low, value);
  }
  return low > high ? scaleOf(0, 0, least) : scaleOf(low, high, least);
}
