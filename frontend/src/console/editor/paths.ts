/** Places within a file: keys and positions, written as the server writes them. */
export type Path = readonly (string | number)[];
export type Json =
  | null
  | boolean
  | number
  | string
  | readonly Json[]
  | { readonly [key: string]: Json };
export type JsonObject = { readonly [key: string]: Json };

/** `conditions[1].latency_ms` */
export function pathText(path: Path): string {
  return path
    .map((part) => (typeof part === "number" ? `[${part}]` : `.${part}`))
    .join("")
    .replace(/^\./, "");
}

/** The value at a place; undefined where there is none. */
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

/** One change of the form, as the server takes it. */
export interface Change {
  readonly path: Path;
  readonly action: "set" | "remove" | "insert" | "move";
  readonly value?: Json;
  readonly to?: number;
}
