import { awaitsFirstFigure, type Dashboard, type FigureEntry } from "@shared/api/analysis";
import { describe, expect, it } from "vitest";
import { chosenFields, unfiltered } from "./filters";

describe("the dashboard's filter", () => {
  it("counts the fields that limit what is shown, whatever the kind", () => {
    const all = unfiltered("simulated");
    expect(chosenFields(all)).toBe(0);
    expect(chosenFields({ ...all, participant: ["P-1", "P-2"], rows: "all" })).toBe(2);
    expect(chosenFields({ ...all, since: "2026-01-01", limb: "foot", order: "0 125" })).toBe(3);
  });
});

describe("the dashboard of simulated people on their way", () => {
  const entry = (figure: FigureEntry["figure"]) => ({ figure }) as FigureEntry;
  const of = (more: Partial<Dashboard>) =>
    awaitsFirstFigure({ simulated: true, n_running: 3, figures: [entry(null)], ...more });

  it("is requested again until there is a first figure, and never while people take part", () => {
    expect(of({})).toBe(true);
    expect(of({ figures: [entry(null), entry({ data: [] })] })).toBe(false);
    expect(of({ n_running: 0 })).toBe(false);
    expect(of({ simulated: false })).toBe(false);
    expect(awaitsFirstFigure(undefined)).toBe(false);
  });
});
