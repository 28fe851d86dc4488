import { describe, expect, it } from "vitest";
import { heightOf, labelled, type Palette, styled } from "./layout";

const palette: Palette = { ink: "#111", soft: "#555", line: "#ccc", sim: "#53a", font: "serif" };

describe("the styling of a figure", () => {
  it("keeps the server's layout and applies the page's colours to every axis", () => {
    const layout = styled(
      { xaxis: { title: { text: "Added latency (ms)" } }, yaxis2: { range: [0, 1] }, template: {} },
      palette,
      null,
    );
    expect(layout.xaxis).toMatchObject({
      title: { text: "Added latency (ms)" },
      gridcolor: "#ccc",
    });
    expect(layout.yaxis2).toMatchObject({ range: [0, 1], gridcolor: "#ccc" });
    expect(layout).not.toHaveProperty("template");
    expect(layout.annotations).toEqual([]);
  });

  it("adds a watermark to a figure of simulated data and keeps its annotations", () => {
    const { annotations } = styled({ annotations: [{ text: "n = 6" }] }, palette, "SIMULATED");
    expect(annotations).toMatchObject([{ text: "n = 6" }, { text: "SIMULATED" }]);
  });

  it("writes direct labels in the page's ink and leaves other traces as they are", () => {
    const line = { mode: "lines", line: { color: "#0072B2" } };
    const mean = { ...line, text: ["mean"], textfont: { color: "#0072B2", size: 12 } };
    expect(labelled([line, mean], palette)).toEqual([
      line,
      { ...mean, textfont: { color: "#111", size: 12 } },
    ]);
  });

  it("uses the height that the server requests", () => {
    expect(heightOf({ data: [], layout: { height: 660 } })).toBe(660);
    expect(heightOf({ data: [] })).toBeGreaterThan(300);
    expect(styled({ height: 660 }, palette, null)).not.toHaveProperty("height");
  });
});
