import { existsSync, readdirSync, readFileSync, statSync } from "node:fs";
import { dirname, join, relative, resolve, sep } from "node:path";
import { describe, expect, it } from "vitest";

const SOURCE = resolve(import.meta.dirname, "..");
const ALIASES: Readonly<Record<string, string>> = { "@shared": "shared", "@charts": "charts" };

/** What each part of the frontend may import in addition to itself and packages. */
const MAY_IMPORT: Readonly<Record<string, readonly string[]>> = {
  shared: [],
  charts: ["shared"],
  console: ["shared", "charts"],
  tablet: ["shared", "charts"],
  vr: ["shared", "charts"],
};

const files = readdirSync(SOURCE, { recursive: true, encoding: "utf8" })
  .filter((name) => /\.tsx?$/.test(name) && !name.endsWith(".d.ts"))
  .map((name) => join(SOURCE, name));

const partOf = (file: string): string => relative(SOURCE, file).split(sep)[0] ?? "";

/** The path an import leads to, without the file extension; null for packages. */
function target(file: string, specifier: string): string | null {
  const [head = "", ...rest] = specifier.split("/");
  const alias = ALIASES[head];
  if (alias !== undefined) return join(SOURCE, alias, ...rest);
  return specifier.startsWith(".") ? resolve(dirname(file), specifier) : null;
}

/** The specifiers of all imports in a source text, including type-only and dynamic ones. */
const importsOf = (text: string): readonly string[] =>
  [...text.matchAll(/\b(?:from|import)\s*\(?\s*"([^"]+)"/g)].map(([, specifier = ""]) => specifier);

function violations(file: string): readonly string[] {
  const part = partOf(file);
  const allowed = [part, ...(MAY_IMPORT[part] ?? [])];
  return importsOf(readFileSync(file, "utf8"))
    .filter((specifier) => {
      const leadsTo = target(file, specifier);
      return leadsTo !== null && !allowed.includes(partOf(leadsTo));
    })
    .map((specifier) => `${relative(SOURCE, file)} imports ${specifier}`);
}

/** The source file that an import leads to; null for packages and styles. */
function sourceFile(file: string, specifier: string): string | null {
  const place = target(file, specifier);
  if (place === null) return null;
  const endings = ["", ".ts", ".tsx", "/index.ts"].map((ending) => place + ending);
  return endings.find((name) => /\.tsx?$/.test(name) && isFile(name)) ?? null;
}

const isFile = (name: string): boolean => existsSync(name) && statSync(name).isFile();

type Graph = ReadonlyMap<string, readonly string[]>;

const graphOf = (names: readonly string[]): Graph =>
  new Map(
    names.map((file) => {
      const imports = importsOf(readFileSync(file, "utf8"));
      return [file, imports.flatMap((specifier) => sourceFile(file, specifier) ?? [])];
    }),
  );

/** The first import cycle reached from each file, as the path around it; empty if there is none. */
function cycles(graph: Graph): readonly string[] {
  const done = new Set<string>();
  const found: string[] = [];
  const visit = (file: string, way: readonly string[]): void => {
    if (way.includes(file)) {
      found.push([...way.slice(way.indexOf(file)), file].join(" -> "));
    } else if (!done.has(file)) {
      for (const next of graph.get(file) ?? []) visit(next, [...way, file]);
      done.add(file);
    }
  };
  for (const file of graph.keys()) visit(file, []);
  return found;
}

describe("imports", () => {
  it("run one way: shared < charts < console, tablet, vr; the pages do not import each other", () => {
    expect(files.length).toBeGreaterThan(50);
    expect(files.flatMap(violations)).toEqual([]);
  });

  it("that break this rule are detected", () => {
    const page = target(join(SOURCE, "tablet/Tablet.tsx"), "../console/Shell");
    expect(page).toBe(join(SOURCE, "console/Shell"));
    const shared = target(join(SOURCE, "console/pages/A.tsx"), "@shared/units");
    expect(partOf(shared ?? "")).toBe("shared");
  });

  it("never form a cycle, including type-only and dynamic imports", () => {
    const graph = graphOf(files);
    const arrows = [...graph.values()].reduce((sum, to) => sum + to.length, 0);
    expect(arrows).toBeGreaterThan(files.length);
    expect(cycles(graph).map((cycle) => cycle.replaceAll(SOURCE + sep, ""))).toEqual([]);
  });

  it("that form a cycle are detected", () => {
    const text = 'import type { A } from "./b";\nconst lazy = () => import("./c");';
    expect(importsOf(text)).toEqual(["./b", "./c"]);
    const graph = new Map([
      ["a", ["b", "c"]],
      ["b", ["c"]],
      ["c", ["a"]],
    ]);
    expect(cycles(graph)).toEqual(["a -> b -> c -> a"]);
  });
});
