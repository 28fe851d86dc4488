/** When a consent is complete, and what of it is sent. */
import type { ConsentForm, ConsentGiven } from "@shared/api/records";

export interface Signing {
  readonly ticked: readonly number[];
  readonly name: string;
  readonly path: string;
  /** Whether the name is typed instead of drawn. */
  readonly types: boolean;
}

export const UNSIGNED: Signing = { ticked: [], name: "", path: "", types: false };

/** Shorter signatures count as accidental, units of the surface. */
const SHORTEST = 60;

export type Missing = "statements" | "name" | "signature";

export function missingOf(form: ConsentForm, signing: Signing): Missing | null {
  const required = form.statements
    .map((one, at) => (one.optional ? -1 : at))
    .filter((at) => at >= 0);
  if (required.some((at) => !signing.ticked.includes(at))) return "statements";
  if (form.signature === "none") return null;
  const types = form.signature === "typed" || signing.types;
  if (types) return signing.name.trim() === "" ? "name" : null;
  return lengthOf(signing.path) < SHORTEST ? "signature" : null;
}

export function consentToSend(
  form: ConsentForm,
  signing: Signing,
  stepIndex: number,
): ConsentGiven {
  const types = form.signature === "typed" || (form.signature === "drawn" && signing.types);
  return {
    step_index: stepIndex,
    ticked: [...signing.ticked].sort((a, b) => a - b),
    name: types ? signing.name.trim() : null,
    signature: form.signature === "drawn" && !types ? signing.path : null,
  };
}

/** The total length of all strokes. */
export function lengthOf(path: string): number {
  return path
    .split("M")
    .map((stroke) => stroke.split("L").map((point) => point.split(" ").map(Number)))
    .reduce((sum, points) => sum + alongside(points), 0);
}

const alongside = (points: readonly (readonly number[])[]): number =>
  points.slice(1).reduce((sum, [x = 0, y = 0], at) => {
    const [fromX = 0, fromY = 0] = points[at] ?? [];
    return sum + Math.hypot(x - fromX, y - fromY);
  }, 0);
