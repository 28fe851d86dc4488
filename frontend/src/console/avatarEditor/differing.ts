/** What two configurations differ in: by body group, and by how much. */
import { PARTS } from "@shared/avatar/anatomy.generated";
import { number } from "@shared/format";
import { type Difference, partOf, SECTIONS, type Section, sectionOf } from "./axes";

const WHOLE = "all";

/** The differences by body group: what concerns the whole body first, then in the body's order. */
export function grouped(
  found: readonly Difference[],
): readonly (readonly [group: string, rows: readonly Difference[]])[] {
  const groupOf = ({ path: [first = "", second] }: Difference): string => {
    if (second === undefined) return WHOLE;
    if (SECTIONS.includes(second as Section)) return second;
    const part = first === "axes" || first === "held_deg" ? partOf(second) : second;
    return PART_NAMES.has(part) ? sectionOf(part) : WHOLE;
  };
  return [WHOLE, ...SECTIONS]
    .map((group) => [group, found.filter((one) => groupOf(one) === group)] as const)
    .filter(([, rows]) => rows.length > 0);
}

/** Difference and percent of a number that has changed; nothing of anything else. */
export function changeOf(
  { before, after }: Pick<Difference, "before" | "after">,
  language: string,
): readonly [difference: string, percent: string] {
  if (typeof before !== "number" || typeof after !== "number") return ["", ""];
  const signed = (value: number, digits: number) =>
    `${value > 0 ? "+" : ""}${number(value, language, digits).replace("-", "−")}`;
  return [
    signed(after - before, 3),
    before === 0 ? "" : signed((100 * (after - before)) / Math.abs(before), 1),
  ];
}

const PART_NAMES: ReadonlySet<string> = new Set(PARTS.map(({ name }) => name));
