import { readdirSync, readFileSync } from "node:fs";
import { dirname, join, relative, resolve, sep } from "node:path";
import { describe, expect, it } from "vitest";

const SOURCE = resolve(import.meta.dirname, "..");
const ALIASES: Readonly<Record<string, string>> = { "@shared": "shared", "@charts": "charts" };

/** What each part of the frontend may import besides itself and packages. */
const MAY_IMPORT: Readonly<Record<string, readonly string[]>> = {
  shared: [],
  charts: ["shared"],
  console: ["shared", "charts"],
  tablet: ["shared", "charts"],
  vr: ["shared", "charts"],
};

const partOf = (file: string): string => relative(SOURCE, file).split(sep)[0] ?? "";

/** The part an import leads to; null for packages. */
function target(file: string, specifier: string): string | null {
  const alias = ALIASES[specifier.split("/")[0] ?? ""];
  if (alias !== undefined) return alias;
  return specifier.startsWith(".") ? partOf(resolve(dirname(file), specifier)) : null;
}

function violations(file: string): readonly string[] {
  const part = partOf(file);
  const allowed = [part, ...(MAY_IMPORT[part] ?? [])];
  const imports = readFileSync(file, "utf8").matchAll(/(?:from|import)\s*\(?\s*"([^"]+)"/g);
  return [...imports]
    .map(([, specifier = ""]) => ({ specifier, leadsTo: target(file, specifier) }))
    .filter(({ leadsTo }) => leadsTo !== null && !allowed.includes(leadsTo))
    .map(({ specifier }) => `${relative(SOURCE, file)} imports ${specifier}`);
}

const files = readdirSync(SOURCE, { recursive: true, encoding: "utf8" })
  .filter((name) => /\.tsx?$/.test(name) && !name.endsWith(".d.ts"))
  .map((name) => join(SOURCE, name));

describe("imports", () => {
  it("run one way: shared < charts < console, tablet; the pages know nothing of each other", () => {
    expect(files.length).toBeGreaterThan(50);
    expect(files.flatMap(violations)).toEqual([]);
  });

  it("would be caught if they did not", () => {
    expect(target(join(SOURCE, "tablet/Tablet.tsx"), "../console/Shell")).toBe("console");
    expect(target(join(SOURCE, "console/pages/A.tsx"), "@shared/units")).toBe("shared");
  });
});
