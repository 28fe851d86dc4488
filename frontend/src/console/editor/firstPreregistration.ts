/** The preregistration that the editor begins with: valid, and of what the study itself measures. */
import { isList, isObject, type Json, type JsonObject } from "./paths";

const ALPHA = 0.05;
const FEWEST_PARTICIPANTS = 2;
const MOST_PARTICIPANTS = 10_000;
const USUAL_PARTICIPANTS = 12;
/** Friedman's test compares at least so many conditions. */
const FRIEDMAN_CONDITIONS = 3;

export interface KnownOfStudy {
  /** Participants until the first ledger is full; null while the study has problems. */
  readonly slots: number | null;
  /** The keys of the scores of every instrument in the library. */
  readonly scores: Readonly<Record<string, readonly string[]>>;
}

/** One primary test that fits the study: its first scored questionnaire, else completed tasks. */
export function firstPreregistration(tree: JsonObject, known: KnownOfStudy): JsonObject {
  const conditions = objectsIn(tree.conditions);
  return {
    alpha: ALPHA,
    planned_n: plannedParticipants(tree, conditions.length, known.slots),
    primary: { ...measured(tree, known.scores), ...test(conditions) },
  };
}

function measured(tree: JsonObject, scores: KnownOfStudy["scores"]): JsonObject {
  const procedure = isObject(tree.procedure) ? tree.procedure : {};
  const block = isObject(procedure.block) ? procedure.block : {};
  const phases = objectsIn(block.phases);
  for (const { limb, questionnaire } of phases) {
    const [score] = typeof questionnaire === "string" ? (scores[questionnaire] ?? []) : [];
    // A score is the same one after every task of its limb.
    const isAskedAlways = phases.every(
      (other) => other.limb !== limb || other.questionnaire === questionnaire,
    );
    if (score === undefined || questionnaire === undefined || limb === undefined || !isAskedAlways)
      continue;
    return { measure: "score", instrument: questionnaire, score, limb };
  }
  return { measure: "completions", limb: phases[0]?.limb ?? "hand" };
}

function test(conditions: readonly JsonObject[]): JsonObject {
  if (conditions.length >= FRIEDMAN_CONDITIONS) return { test: "friedman" };
  const [lowest] = conditions.toSorted((one, other) => latencyOf(one) - latencyOf(other));
  return typeof lowest?.key === "string"
    ? { test: "against_reference", reference: lowest.key }
    : { test: "rm_anova" };
}

const latencyOf = ({ latency_ms }: JsonObject): number =>
  typeof latency_ms === "number" ? latency_ms : 0;

function plannedParticipants(tree: JsonObject, conditions: number, slots: number | null): number {
  const orders = isObject(tree.orders) ? tree.orders : {};
  const replicates = typeof orders.replicates === "number" ? orders.replicates : 1;
  const planned = slots ?? replicates * ordersOf(orders, conditions);
  return planned >= FEWEST_PARTICIPANTS && planned <= MOST_PARTICIPANTS
    ? Math.floor(planned)
    : USUAL_PARTICIPANTS;
}

/** How many orders a design has; 0 if that cannot be said. */
function ordersOf({ design, sequences }: JsonObject, conditions: number): number {
  switch (design) {
    case "all_permutations":
      return Array.from({ length: conditions }, (_, at) => at + 1).reduce((a, b) => a * b, 1);
    case "williams":
      return conditions % 2 === 0 ? conditions : 2 * conditions;
    default:
      return isList(sequences) ? sequences.length : 0;
  }
}

const objectsIn = (value: Json | undefined): readonly JsonObject[] =>
  isList(value) ? value.filter(isObject) : [];
