import type { Paragraph } from "@shared/text";
import { describe, expect, it } from "vitest";
import { MAX_WORDS, pagesOfText, Reading } from "./reading";
import { fits } from "./surface/layout";
import { wideMeasure } from "./testing/pointing";
import { panelWords } from "./texts";

const SENTENCE = "You stand on a square and touch the panels in the order of their numbers.";
const TEXT = `# The tasks

${Array(9).fill(SENTENCE).join(" ")}

![mirror]

# With the hand

- ${SENTENCE}
- ${SENTENCE}
- ${SENTENCE}
- ${SENTENCE}
- ${SENTENCE}

Touch nothing else.`;

const words = (part: Paragraph): readonly string[] =>
  part.kind === "points"
    ? part.points.join(" ").split(" ")
    : part.kind === "picture"
      ? []
      : part.text.split(" ");

describe("a long text", () => {
  const pages = pagesOfText(TEXT, () => true);

  it("keeps every word once, in order, at most 60 on a page", () => {
    const whole = TEXT.replace(/!\[mirror\]|^# |^- /gm, "")
      .split(/\s+/)
      .filter((word) => word !== "");
    expect(pages.flat().flatMap(words)).toEqual(whole);
    for (const page of pages) expect(page.flatMap(words).length).toBeLessThanOrEqual(MAX_WORDS);
    expect(pages.length).toBeGreaterThan(3);
  });

  it("is divided between sentences, and a heading stays with what follows", () => {
    for (const page of pages) {
      expect(page.at(-1)?.kind).not.toBe("heading");
      for (const part of page) if (part.kind === "prose") expect(part.text).toMatch(/[.!?]$/);
    }
  });

  it("divides a sentence that is longer than a page", () => {
    const long = Array.from({ length: 130 }, (_, at) => `word${at}`).join(" ");
    const divided = pagesOfText(long, () => true);
    expect(divided.flat().flatMap(words)).toEqual(long.split(" "));
    for (const page of divided) expect(page.flatMap(words).length).toBeLessThanOrEqual(MAX_WORDS);
  });

  it("fits the panel on every page, in both languages", () => {
    for (const language of ["en", "de"]) {
      const reading = new Reading({
        title: "Anleitung",
        text: TEXT.replaceAll("panels", "Handlungsurheberschaftsempfinden"),
        words: panelWords(language),
        measure: wideMeasure,
        onRead: () => {},
        onAsk: () => {},
      });
      for (let page = 0; page < 12; page += 1) {
        expect(fits(reading.screen, wideMeasure)).toBe(true);
        reading.press("next");
      }
    }
  });
});

describe("reading", () => {
  const read: string[] = [];
  const start = () =>
    new Reading({
      title: "Instructions",
      text: TEXT,
      words: panelWords("en"),
      measure: wideMeasure,
      onRead: () => read.push("read"),
      onAsk: () => read.push("asked"),
    });
  const targets = (reading: Reading) => reading.screen.buttons?.map(({ target }) => target);

  it("goes on and back, and is confirmed on the last page only", () => {
    const reading = start();
    expect(targets(reading)).toEqual(["ask", "next"]);
    let pages = 1;
    while (targets(reading)?.includes("next")) {
      reading.press("next");
      pages += 1;
      expect(targets(reading)).toContain("back");
    }
    expect(targets(reading)).toEqual(["back", "ask", "done"]);
    reading.press("done");
    expect(read).toEqual(["read"]);
    for (let page = 1; page < pages; page += 1) reading.press("back");
    expect(targets(reading)).toEqual(["ask", "next"]);
  });

  it("calls the experimenter for a question, and goes on where it was", () => {
    const reading = start();
    const before = reading.screen.key;
    reading.press("ask");
    expect(read.at(-1)).toBe("asked");
    expect(reading.screen.title).toBe("The experimenter has been called");
    reading.press("continue");
    expect(reading.screen.key).toBe(before);
  });
});
