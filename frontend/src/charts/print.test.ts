import { describe, expect, it } from "vitest";
import { printed, wrapped } from "./print";

describe("a figure saved as a picture", () => {
  it("is black on white, with its title and caption and the mark of simulated data", () => {
    const figure = { data: [], layout: { height: 600, margin: { l: 60, r: 20, t: 36, b: 84 } } };
    const words = { title: "Agency <1>", caption: "n = 6 participants.", watermark: "SIMULATED" };
    const { layout, height } = printed(figure, words, false);
    expect(layout.paper_bgcolor).toBe("#ffffff");
    expect(layout.title).toMatchObject({ text: "Agency &lt;1&gt;" });
    expect(layout.annotations).toMatchObject([
      { text: "SIMULATED" },
      { text: "n = 6 participants." },
    ]);
    expect(height).toBeGreaterThan(600);
  });

  it("makes room for a long caption, line by line", () => {
    const caption = "word ".repeat(200);
    expect(wrapped(caption, 20).every((line) => line.length <= 20)).toBe(true);
    expect(wrapped(caption, 20).join(" ")).toBe(caption.trim());
    const words = { title: "", caption: "", watermark: null };
    const short = printed({}, words, false).height;
    expect(printed({}, { ...words, caption }, false).height).toBeGreaterThan(short + 50);
  });
});
