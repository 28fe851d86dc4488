/** A path within a file: keys and positions, in the server's notation. */
export type Path = readonly (string | number)[];
export type Json =
  | null
  | boolean
  | number
  | string
  | readonly Json[]
  | { readonly [key: string]: Json };
export type JsonObject = { readonly [key: string]: Json };

/** A path as text: `conditions[1].latency_ms`. */
export function pathText(path: Path): string {
  return path
    .map((part) => (typeof part === "number" ? `[${part}]` : `.${part}`))
    .join("")
    .replace(/^\./, "");
}

/** The value at a path; undefined if there is none. */
export function valueAt(tree: Json | undefined, path: Path): Json | undefined {
  let node = tree;
  for (const part of path) {
    if (Array.isArray(node) && typeof part === "number") node = node[part];
    else if (isObject(node)) node = node[String(part)];
    else return undefined;
  }
  return node;
}

export const isObject = (value: Json | undefined): value is JsonObject =>
  typeof value === "object" && value !== null && !Array.isArray(value);

export const isList = (value: Json | undefined): value is readonly Json[] => Array.isArray(value);

/** One change of the form, in the format of the server. */
export interface Change {
  readonly path: Path;
  readonly action: "set" | "remove" | "insert" | "move";
  readonly value?: Json;
  readonly to?: number;
}
