import { paragraphs } from "@shared/text";
import { describe, expect, it } from "vitest";
import { wideMeasure } from "../testing/pointing";
import { type Layout, layOut, PANEL_DMM, type Rectangle } from "./layout";
import type { Choice, PanelScreen } from "./screen";
import { wrap } from "./wrap";

const lay = (screen: Omit<PanelScreen, "key">) => layOut({ key: "test", ...screen }, wideMeasure);
const rows = (count: number, text = "somewhat agree"): Choice[] =>
  Array.from({ length: count }, (_, at) => ({ target: `answer ${at}`, text, badge: String(at) }));

const FOOT = [
  { target: "back", text: "Zurück", side: "left" },
  { target: "next", text: "Antworten prüfen", side: "right", isPrimary: true },
] as const;

const LONG =
  "Es fühlte sich an, als würde mein (echter) Körper auf den virtuellen Körper zutreiben oder als" +
  " würde der virtuelle Körper auf meinen echten Körper zutreiben.";

const overlap = (a: Rectangle, b: Rectangle): boolean =>
  a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;

/** The rectangles of all lines of text. */
const lines = ({ marks }: Layout): readonly Rectangle[] =>
  marks.flatMap((mark) => {
    if (mark.kind !== "text") return [];
    const { sizeDmm, isBold } = mark.font;
    const width = wideMeasure(mark.text, sizeDmm, isBold);
    const left = { left: mark.x, center: mark.x - width / 2, right: mark.x - width }[mark.align];
    return [{ x: left, y: mark.y - sizeDmm * 0.6, width, height: sizeDmm * 1.2 }];
  });

const SCREENS: Readonly<Record<string, Omit<PanelScreen, "key">>> = {
  "a question with seven named steps": {
    lead: "Während des Experiments gab es Momente, auf die Folgendes zutraf ...",
    title: LONG,
    isQuestion: true,
    choices: { layout: "rows", items: rows(7, "stimme überhaupt nicht zu") },
    progress: { done: 3, of: 15, text: "Frage 3 von 15" },
    buttons: FOOT,
  },
  "a scale between two ends": {
    title: LONG,
    isQuestion: true,
    choices: {
      layout: "steps",
      items: rows(21, "100"),
      ends: ["überhaupt nicht anstrengend", "außerordentlich anstrengend"],
    },
    buttons: FOOT,
  },
  "a keypad": {
    title: "Wie alt sind Sie?",
    isQuestion: true,
    choices: { layout: "keys", items: rows(12, "7"), entry: "", hint: "18 bis 110 Jahre" },
    problem: "Bitte beantworten Sie diese Frage.",
    buttons: FOOT,
  },
  "a text with points": {
    title: "Anleitung",
    body: paragraphs(`# Die Aufgaben\n\n${LONG}\n\n- eins zwei drei\n- ${LONG}`),
    buttons: FOOT,
  },
};

describe("a screen on a panel", () => {
  for (const [name, screen] of Object.entries(SCREENS)) {
    it(`holds ${name}: text of 24 dmm or more, inside the panel, and nothing on something else`, () => {
      const layout = lay(screen);
      const sizes = layout.marks.flatMap((mark) => (mark.kind === "text" ? mark.font.sizeDmm : []));
      expect(Math.min(...sizes)).toBeGreaterThanOrEqual(24);
      const texts = lines(layout);
      for (const { x, y, width, height } of [...texts, ...layout.targets.map(({ at }) => at)]) {
        expect(x).toBeGreaterThanOrEqual(20);
        expect(y).toBeGreaterThanOrEqual(20);
        expect(x + width).toBeLessThanOrEqual(layout.widthDmm - 20);
        expect(y + height).toBeLessThanOrEqual(layout.heightDmm - 20);
      }
      for (const [index, one] of texts.entries()) {
        for (const other of texts.slice(index + 1)) expect(overlap(one, other)).toBe(false);
      }
    });

    it(`has targets of 60 dmm or more in ${name}, 12 dmm apart, each text inside or outside`, () => {
      const layout = lay(screen);
      for (const [index, { at }] of layout.targets.entries()) {
        expect(at.height).toBeGreaterThanOrEqual(60);
        expect(at.width).toBeGreaterThanOrEqual(55);
        const around = { x: at.x - 11, y: at.y - 11, width: at.width + 22, height: at.height + 22 };
        for (const other of layout.targets.slice(index + 1)) {
          expect(overlap(around, other.at)).toBe(false);
        }
        for (const line of lines(layout).filter((one) => overlap(one, at))) {
          expect(line.x).toBeGreaterThanOrEqual(at.x);
          expect(line.x + line.width).toBeLessThanOrEqual(at.x + at.width);
        }
      }
    });
  }

  it("is the usual panel for a usual question, and a larger one for what needs it", () => {
    const title = "I felt as if the virtual body I saw was someone else.";
    const usual = {
      title,
      isQuestion: true,
      choices: { layout: "rows", items: rows(7) },
      buttons: FOOT,
    };
    expect(lay(usual as Omit<PanelScreen, "key">).widthDmm).toBe(PANEL_DMM.width);
    const larger = lay({ title: LONG, choices: { layout: "rows", items: rows(9) }, buttons: FOOT });
    expect(larger.widthDmm).toBeGreaterThan(PANEL_DMM.width);
  });

  it("that holds too much for any panel is refused, with what to do", () => {
    expect(() => lay({ choices: { layout: "rows", items: rows(60) } })).toThrow(/divide its text/);
  });

  it("shortens what only has to be recognised", () => {
    const items = [{ target: "a", text: LONG.repeat(3), maxLines: 2 }];
    const { marks } = lay({ choices: { layout: "rows", items } });
    const texts = marks.flatMap((mark) => (mark.kind === "text" ? mark.text : []));
    expect(texts).toHaveLength(2);
    expect(texts[1]).toMatch(/ …$/);
  });
});

describe("lines of text", () => {
  const font = { sizeDmm: 24, isBold: false };

  it("hold every word once and none is wider than the line", () => {
    const wrapped = wrap(LONG, 400, font, wideMeasure);
    expect(wrapped.join(" ")).toBe(LONG);
    for (const line of wrapped) expect(wideMeasure(line, 24, false)).toBeLessThanOrEqual(400);
  });

  it("break a word that is wider than the line, with a hyphen", () => {
    const word = "Handlungsurheberschaftsempfinden";
    const wrapped = wrap(word, 150, font, wideMeasure);
    expect(wrapped.length).toBeGreaterThan(2);
    expect(wrapped.map((line) => line.replace(/-$/, "")).join("")).toBe(word);
    for (const line of wrapped) expect(wideMeasure(line, 24, false)).toBeLessThanOrEqual(150);
  });
});
