/** Compare the console's table of permissions with the server's, read from its own file. */
import { readFileSync } from "node:fs";
import { describe, expect, it } from "vitest";
import { RULES } from "./permissions";

const SOURCE = readFileSync(new URL("../../../app/platform/policy.py", import.meta.url), "utf-8");
const SETS = new Map(
  [...SOURCE.matchAll(/^([A-Z]+) = frozenset\(\{(.+)\}\)$/gm)].map(([, name, roles]) => [
    name,
    [...(roles ?? "").matchAll(/"(\w+)"/g)].map(([, role]) => role).sort(),
  ]),
);
const POLICY = new Map(
  [...SOURCE.matchAll(/^ {4}"([A-Z]+ \/api\/\S+)": ([A-Z]+),$/gm)].map(([, route, set]) => [
    route,
    SETS.get(set),
  ]),
);

describe("the console's table of permissions", () => {
  it("covers every row of the server's", () => {
    expect(POLICY.size).toBe(SOURCE.split("/api/").length - 1);
  });

  it.each(Object.entries(RULES))("gives %s to those to whom the server does", (_, rule) => {
    for (const route of rule.routes)
      expect([route, POLICY.get(route)]).toEqual([route, [...rule.roles].sort()]);
  });
});
