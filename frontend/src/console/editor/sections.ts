/** How the settings of a study are grouped into pages of the form. */
import type { ConfigProblem } from "@shared/api/types";
import type { ObjectSpec } from "./schema";

export const SECTIONS = [
  "basics",
  "conditions",
  "orders",
  "procedure",
  "tasks",
  "safety",
  "validity",
  "texts",
  "blinding",
  "places",
  "preregistration",
  "simulation",
] as const;
export type Section = (typeof SECTIONS)[number];

/**
 * Which settings belong to a section, by the beginning of their path. All others are shown under
 * safety.
 */
const CLAIMED: Readonly<Record<Section, readonly string[]>> = {
  basics: [
    "key",
    "title",
    "description",
    "languages",
    "avatar",
    "avatar_configuration",
    "provenance",
  ],
  conditions: ["conditions", "latency"],
  orders: ["orders"],
  procedure: ["procedure"],
  tasks: ["procedure.block.phases"],
  safety: ["procedure.block.after"],
  validity: ["valid_when"],
  texts: ["texts"],
  blinding: ["blinding", "on_disconnect"],
  places: ["tasks", "appearance"],
  preregistration: ["preregistration"],
  simulation: ["simulation"],
};

/** The top-level settings of a section, in the order of the file. */
export function fieldsOf(section: Section, spec: ObjectSpec): ObjectSpec {
  const claimed = new Set(Object.values(CLAIMED).flat());
  const mine = new Set(CLAIMED[section]);
  return {
    kind: "object",
    fields: spec.fields.filter(
      ({ name }) => mine.has(name) || (section === "safety" && !claimed.has(name)),
    ),
  };
}

/** The section in which a problem can be fixed: the one with the longest matching path. */
export function sectionOf(problem: Pick<ConfigProblem, "path">): Section {
  let found: Section = "safety";
  let length = 0;
  for (const section of SECTIONS) {
    for (const prefix of CLAIMED[section]) {
      const rest = problem.path.slice(prefix.length);
      if (problem.path.startsWith(prefix) && /^($|[.[])/.test(rest) && prefix.length > length) {
        found = section;
        length = prefix.length;
      }
    }
  }
  return found;
}
