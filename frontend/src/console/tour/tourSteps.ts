/** What the tour shows, in order, and where on the page each thing is. */
type Side = "top" | "right" | "bottom" | "left";

export interface TourStep {
  readonly key: "timeline" | "clock" | "next" | "live" | "tablet" | "alarms" | "replay" | "csv";
  /** Marks (`data-tour`) of what is pointed at; the first that is on the page. */
  readonly marks: readonly string[];
  readonly side: Side;
}

export const TOUR_STEPS: readonly TourStep[] = [
  { key: "timeline", marks: ["timeline"], side: "right" },
  { key: "clock", marks: ["clock", "step"], side: "bottom" },
  { key: "next", marks: ["next", "step"], side: "bottom" },
  { key: "live", marks: ["live", "centre"], side: "top" },
  { key: "tablet", marks: ["devices", "side"], side: "left" },
  { key: "alarms", marks: ["signal"], side: "bottom" },
  { key: "replay", marks: ["replay", "head"], side: "bottom" },
  { key: "csv", marks: ["csv", "downloads"], side: "bottom" },
];

export const anchorOf = (step: TourStep): HTMLElement | null => {
  for (const mark of step.marks) {
    const found = document.querySelector<HTMLElement>(`[data-tour="${mark}"]`);
    if (found !== null) return found;
  }
  return null;
};
