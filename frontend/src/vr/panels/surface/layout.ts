/**
 * Lay a screen out: where every line, row and button lies, in dmm from the panel's upper left corner.
 *
 * Distances and sizes follow three rules: text is at least 24 dmm tall (Google's guideline for
 * reading in VR, "Designing Screen Interfaces for VR", I/O 2017), what can be pressed is at least
 * 60 dmm tall and 12 dmm from the next, and one thing is asked at a time. Where a text is too long
 * for the panel, the panel grows; text never gets smaller than that.
 */
import type { Paragraph } from "@shared/text";
import type { Choice, Choices, PanelButton, PanelScreen } from "./screen";
import { type Font, type Measure, wrap } from "./wrap";

export interface Rectangle {
  readonly x: number;
  readonly y: number;
  readonly width: number;
  readonly height: number;
}

export type Ink = "plain" | "soft" | "accent" | "onAccent" | "problem";

export type Mark =
  | {
      readonly kind: "text";
      readonly x: number;
      /** The middle of the line. */
      readonly y: number;
      readonly text: string;
      readonly font: Font;
      readonly ink: Ink;
      readonly align: "left" | "center" | "right";
    }
  | {
      readonly kind: "box";
      readonly at: Rectangle;
      readonly radius: number;
      readonly fill: "row" | "chosen" | "primary" | "field" | "track" | "done" | "problem" | null;
      readonly line: "row" | "chosen" | null;
    }
  | { readonly kind: "tick"; readonly x: number; readonly y: number; readonly size: number }
  | { readonly kind: "alert"; readonly x: number; readonly y: number; readonly size: number };

export interface Target {
  readonly target: string;
  readonly at: Rectangle;
}

export interface Layout {
  readonly widthDmm: number;
  readonly heightDmm: number;
  readonly marks: readonly Mark[];
  readonly targets: readonly Target[];
}

/** 49 by 41 degrees: inside what a headset shows at once, without turning the head. */
export const PANEL_DMM = { width: 920, height: 760 } as const;

export const TEXT_DMM = 26;
const SMALL_DMM = 24;
const TITLE_DMM = 36;
const QUESTION_DMM = 30;
const LINE = 1.32;
const PADDING = 40;
const GAP = 12;
const SECTION = 22;
const ROW = 60;
const BUTTON = 72;
const RADIUS = 14;

/**
 * How much larger a panel may grow until its text fits. The last ones are wider than the view: a
 * question with forty answers is read by turning the head, which is better than not at all.
 */
const GROWTH = [1, 1.12, 1.25, 1.4, 1.6, 2, 2.5, 3.2, 4] as const;

const LARGEST = Math.max(...GROWTH);

export class PanelLayoutError extends Error {
  override name = "PanelLayoutError";
}

/** Lay a screen out on the smallest panel that holds it. */
export function layOut(screen: PanelScreen, measure: Measure): Layout {
  for (const growth of GROWTH) {
    const layout = onPanel(screen, PANEL_DMM.width * growth, PANEL_DMM.height * growth, measure);
    if (layout !== null) return layout;
  }
  throw new PanelLayoutError(
    `The screen ${screen.key} does not fit a panel of ${PANEL_DMM.width * LARGEST} by ` +
      `${PANEL_DMM.height * LARGEST} dmm: divide its text into pages or its answers into fewer rows.`,
  );
}

/** Whether a screen fits the panel without making it larger. */
export const fits = (screen: PanelScreen, measure: Measure): boolean =>
  onPanel(screen, PANEL_DMM.width, PANEL_DMM.height, measure) !== null;

function onPanel(
  screen: PanelScreen,
  widthDmm: number,
  heightDmm: number,
  measure: Measure,
): Layout | null {
  const page = new Page(widthDmm, measure);
  if (screen.lead !== undefined) page.text(screen.lead, { sizeDmm: SMALL_DMM, ink: "soft" });
  if (screen.title !== undefined) {
    const sizeDmm = screen.isQuestion ? QUESTION_DMM : TITLE_DMM;
    if (screen.lead !== undefined) page.space(4);
    page.text(screen.title, { sizeDmm, isBold: !screen.isQuestion });
  }
  // The scene itself shows what the pictures of the tablet show: mirror, boxes, the pose.
  const body = (screen.body ?? []).filter(({ kind }) => kind !== "picture");
  for (const [at, paragraph] of body.entries()) {
    page.space(at === 0 ? SECTION - 4 : SECTION);
    page.paragraph(paragraph);
  }
  if (screen.choices !== undefined) {
    page.space(SECTION);
    page.choices(screen.choices);
  }
  if (screen.problem) {
    page.space(GAP + 4);
    page.problem(screen.problem);
  }
  const foot = footHeight(screen);
  const needed = page.y + (foot === 0 ? 0 : SECTION) + foot + PADDING;
  if (needed > heightDmm) return null;
  // What is answered page by page keeps its size, so that the buttons stay where they are.
  const isPaged = screen.choices !== undefined || (screen.buttons ?? []).length > 0;
  const height = isPaged && !screen.isLow ? heightDmm : needed;
  page.foot(screen, height - PADDING);
  return { widthDmm, heightDmm: height, marks: page.marks, targets: page.targets };
}

const footHeight = ({ buttons, progress }: PanelScreen): number =>
  buttons !== undefined && buttons.length > 0 ? BUTTON : progress === undefined ? 0 : SMALL_DMM * 2;

/** The first lines, with an ellipsis where there are more. */
function shortened(lines: readonly string[], most = Number.POSITIVE_INFINITY): readonly string[] {
  if (lines.length <= most) return lines;
  const last = lines[most - 1] ?? "";
  return [...lines.slice(0, most - 1), `${last.replace(/\s*\S+$/, "")} …`];
}

interface TextStyle {
  readonly sizeDmm: number;
  readonly isBold?: boolean;
  readonly ink?: Ink;
  readonly indent?: number;
}

class Page {
  readonly marks: Mark[] = [];
  readonly targets: Target[] = [];
  y = PADDING;
  readonly #width: number;
  readonly #measure: Measure;

  constructor(widthDmm: number, measure: Measure) {
    this.#width = widthDmm - 2 * PADDING;
    this.#measure = measure;
  }

  space(dmm: number): void {
    this.y += dmm;
  }

  text(text: string, style: TextStyle): void {
    const { sizeDmm, isBold = false, ink = "plain", indent = 0 } = style;
    const font = { sizeDmm, isBold };
    const height = sizeDmm * LINE;
    for (const line of wrap(text, this.#width - indent, font, this.#measure)) {
      const [x, y] = [PADDING + indent, this.y + height / 2];
      this.marks.push({ kind: "text", x, y, text: line, font, ink, align: "left" });
      this.y += height;
    }
  }

  paragraph(paragraph: Paragraph): void {
    switch (paragraph.kind) {
      case "heading":
        this.text(paragraph.text, { sizeDmm: QUESTION_DMM, isBold: true });
        return;
      case "prose":
        this.text(paragraph.text, { sizeDmm: TEXT_DMM });
        return;
      case "points":
        for (const [at, point] of paragraph.points.entries()) {
          if (at > 0) this.space(8);
          const y = this.y + (TEXT_DMM * LINE) / 2;
          const dot = { x: PADDING + 6, y: y - 4, width: 8, height: 8 };
          this.marks.push({ kind: "box", at: dot, radius: 4, fill: "done", line: null });
          this.text(point, { sizeDmm: TEXT_DMM, indent: 32 });
        }
        return;
      case "picture":
        return;
    }
  }

  choices(choices: Choices): void {
    switch (choices.layout) {
      case "rows":
        for (const [at, item] of choices.items.entries()) {
          if (at > 0) this.space(GAP);
          this.#row(item);
        }
        return;
      case "steps":
        this.#steps(choices.items, choices.ends);
        return;
      case "keys":
        this.#keys(choices.items, choices.entry, choices.hint);
        return;
    }
  }

  #row({ target, text, badge, isChosen = false, detail, maxLines }: Choice): void {
    const inset = 24;
    const left = PADDING + inset + (badge === undefined ? 0 : 52);
    const font = { sizeDmm: TEXT_DMM, isBold: isChosen };
    const soft = { sizeDmm: SMALL_DMM, isBold: false };
    const end = detail === undefined ? 0 : this.#width * 0.34;
    const tick = isChosen ? 44 : 0;
    const room = PADDING + this.#width - inset - end - tick - left;
    const lines = shortened(wrap(text, room, font, this.#measure), maxLines);
    const details = detail === undefined ? [] : wrap(detail, end, soft, this.#measure);
    const lineHeight = TEXT_DMM * LINE;
    const height = Math.max(ROW, Math.max(lines.length, details.length) * lineHeight + 22);
    const at = { x: PADDING, y: this.y, width: this.#width, height };
    this.#pressable(target, at, isChosen ? "chosen" : "row", isChosen ? "chosen" : "row");
    const middle = this.y + height / 2;
    const ink = isChosen ? "accent" : "plain";
    if (badge !== undefined) {
      const x = PADDING + inset;
      const bold = { sizeDmm: TEXT_DMM, isBold: true };
      const badgeInk = isChosen ? "accent" : "soft";
      this.marks.push({
        kind: "text",
        x,
        y: middle,
        text: badge,
        font: bold,
        ink: badgeInk,
        align: "left",
      });
    }
    const put = (
      all: readonly string[],
      x: number,
      style: Font,
      of: Ink,
      align: "left" | "right",
    ) => {
      for (const [index, line] of all.entries()) {
        const y = middle + (index - (all.length - 1) / 2) * lineHeight;
        this.marks.push({ kind: "text", x, y, text: line, font: style, ink: of, align });
      }
    };
    put(lines, left, font, ink, "left");
    put(details, PADDING + this.#width - inset, soft, "soft", "right");
    if (isChosen) {
      this.marks.push({ kind: "tick", x: PADDING + this.#width - inset - 14, y: middle, size: 26 });
    }
    this.y += height;
  }

  #steps(items: readonly Choice[], ends: readonly [string, string] | null): void {
    const rows = Math.max(1, Math.ceil(items.length / 11));
    const each = Math.ceil(items.length / rows);
    const width = (this.#width - GAP * (each - 1)) / each;
    const height = Math.max(ROW, Math.min(84, width));
    for (const [index, { target, text, isChosen = false }] of items.entries()) {
      const x = PADDING + (index % each) * (width + GAP);
      const y = this.y + Math.floor(index / each) * (height + GAP);
      const fill = isChosen ? "chosen" : "row";
      this.#pressable(target, { x, y, width, height }, fill, fill);
      this.marks.push({
        kind: "text",
        x: x + width / 2,
        y: y + height / 2,
        text,
        font: { sizeDmm: TEXT_DMM, isBold: isChosen },
        ink: isChosen ? "accent" : "plain",
        align: "center",
      });
    }
    this.y += rows * height + (rows - 1) * GAP;
    if (ends !== null) this.#ends(ends);
  }

  #ends([low, high]: readonly [string, string]): void {
    this.space(GAP);
    const font = { sizeDmm: SMALL_DMM, isBold: false };
    const half = this.#width / 2 - GAP;
    const left = wrap(low, half, font, this.#measure);
    const right = wrap(high, half, font, this.#measure);
    const put = (lines: readonly string[], x: number, align: "left" | "right") => {
      for (const [index, text] of lines.entries()) {
        const y = this.y + (index + 0.5) * SMALL_DMM * LINE;
        this.marks.push({ kind: "text", x, y, text, font, ink: "soft", align });
      }
    };
    put(left, PADDING, "left");
    put(right, PADDING + this.#width, "right");
    this.y += Math.max(left.length, right.length) * SMALL_DMM * LINE;
  }

  #keys(items: readonly Choice[], entry: string, hint: string): void {
    const width = 3 * 132 + 2 * GAP;
    const left = PADDING + (this.#width - width) / 2;
    const field = { x: left, y: this.y, width, height: 72 };
    this.marks.push({ kind: "box", at: field, radius: RADIUS, fill: "field", line: "row" });
    this.marks.push({
      kind: "text",
      x: left + width / 2,
      y: this.y + 36,
      text: entry === "" ? hint : entry,
      font: { sizeDmm: entry === "" ? SMALL_DMM : TITLE_DMM, isBold: entry !== "" },
      ink: entry === "" ? "soft" : "plain",
      align: "center",
    });
    this.y += 72 + GAP;
    for (const [index, { target, text }] of items.entries()) {
      const x = left + (index % 3) * (132 + GAP);
      const y = this.y + Math.floor(index / 3) * (66 + GAP);
      this.#pressable(target, { x, y, width: 132, height: 66 }, "row", "row");
      const font = { sizeDmm: TITLE_DMM - 6, isBold: false };
      const [at, middle] = [x + 66, y + 33];
      this.marks.push({
        kind: "text",
        x: at,
        y: middle,
        text,
        font,
        ink: "plain",
        align: "center",
      });
    }
    this.y += Math.ceil(items.length / 3) * (66 + GAP) - GAP;
  }

  problem(text: string): void {
    const y = this.y + (TEXT_DMM * LINE) / 2;
    this.marks.push({ kind: "alert", x: PADDING + 14, y, size: 28 });
    this.text(text, { sizeDmm: TEXT_DMM, ink: "problem", indent: 42 });
  }

  /** Buttons at both sides of the lower edge, and the progress between them. */
  foot({ buttons = [], progress }: PanelScreen, bottom: number): void {
    const top = bottom - BUTTON;
    let [left, right] = [PADDING, PADDING + this.#width];
    for (const button of buttons) {
      const width = this.#buttonWidth(button);
      const x = button.side === "left" ? left : right - width;
      if (button.side === "left") left += width + GAP;
      else right -= width + GAP;
      this.#button(button, { x, y: top, width, height: BUTTON });
    }
    if (progress === undefined) return;
    const middle = buttons.length === 0 ? PADDING + this.#width / 2 : (left + right) / 2;
    this.#progress(progress, middle, buttons.length === 0 ? bottom - 26 : top + BUTTON / 2);
  }

  #buttonWidth({ text }: PanelButton): number {
    return Math.max(180, this.#measure(text, TEXT_DMM, true) + 64);
  }

  #button({ target, text, isPrimary = false }: PanelButton, at: Rectangle): void {
    this.#pressable(target, at, isPrimary ? "primary" : "row", isPrimary ? null : "row");
    this.marks.push({
      kind: "text",
      x: at.x + at.width / 2,
      y: at.y + at.height / 2,
      text,
      font: { sizeDmm: TEXT_DMM, isBold: true },
      ink: isPrimary ? "onAccent" : "plain",
      align: "center",
    });
  }

  #progress(
    { done, of, text }: NonNullable<PanelScreen["progress"]>,
    middle: number,
    y: number,
  ): void {
    const width = 220;
    const track = { x: middle - width / 2, y: y + 12, width, height: 8 };
    const share = of === 0 ? 0 : Math.min(1, done / of);
    this.marks.push({ kind: "box", at: track, radius: 4, fill: "track", line: null });
    if (share > 0) {
      const reached = { ...track, width: Math.max(8, width * share) };
      this.marks.push({ kind: "box", at: reached, radius: 4, fill: "done", line: null });
    }
    const font = { sizeDmm: SMALL_DMM, isBold: false };
    this.marks.push({
      kind: "text",
      x: middle,
      y: y - 12,
      text,
      font,
      ink: "soft",
      align: "center",
    });
  }

  #pressable(
    target: string,
    at: Rectangle,
    fill: "row" | "chosen" | "primary",
    line: "row" | "chosen" | null,
  ): void {
    this.marks.push({ kind: "box", at, radius: RADIUS, fill, line });
    this.targets.push({ target, at });
  }
}
