/**
 * Convert the JSON schema of study files to the fields of a form.
 *
 * The form is generated from the schema: whatever the study language gains appears in the editor
 * without a change here.
 */
import type { Json } from "./paths";

interface Raw {
  readonly $ref?: string;
  readonly $defs?: Readonly<Record<string, Raw>>;
  readonly type?: string;
  readonly enum?: readonly string[];
  readonly const?: Json;
  readonly properties?: Readonly<Record<string, Raw>>;
  readonly required?: readonly string[];
  readonly items?: Raw;
  readonly prefixItems?: readonly Raw[];
  readonly minItems?: number;
  readonly anyOf?: readonly Raw[];
  readonly discriminator?: {
    readonly propertyName: string;
    readonly mapping: Record<string, string>;
  };
  readonly additionalProperties?: Raw | boolean;
  readonly patternProperties?: Readonly<Record<string, Raw>>;
  readonly minimum?: number;
  readonly exclusiveMinimum?: number;
  readonly maximum?: number;
  readonly pattern?: string;
  readonly description?: string;
  readonly deprecated?: boolean;
  readonly "x-text"?: boolean;
}

export type Spec =
  | { readonly kind: "texts" }
  | { readonly kind: "choice"; readonly values: readonly string[] }
  | NumberSpec
  | { readonly kind: "boolean" }
  | { readonly kind: "words"; readonly pattern: string | null }
  | { readonly kind: "fixed"; readonly value: Json }
  | ObjectSpec
  | ListSpec
  | UnionSpec
  | { readonly kind: "map"; readonly value: Spec }
  | { readonly kind: "tuple"; readonly items: readonly Spec[] };

export interface NumberSpec {
  readonly kind: "number";
  readonly whole: boolean;
  readonly minimum: number | null;
  readonly maximum: number | null;
  readonly above: number | null;
}
export interface ObjectSpec {
  readonly kind: "object";
  readonly fields: readonly Field[];
}
export interface ListSpec {
  readonly kind: "list";
  readonly item: Spec;
  readonly atLeast: number;
}
export interface UnionSpec {
  readonly kind: "union";
  readonly tag: string;
  readonly options: Readonly<Record<string, ObjectSpec>>;
}
export interface Field {
  readonly name: string;
  readonly spec: Spec;
  readonly required: boolean;
}

/** The form of a whole file. */
export function specOfFile(schema: unknown): ObjectSpec {
  const root = schema as Raw;
  const spec = specOf(root, root);
  return spec.kind === "object" ? spec : { kind: "object", fields: [] };
}

function specOf(root: Raw, given: Raw): Spec {
  const node = resolved(root, given);
  if (node["x-text"] === true) return { kind: "texts" };
  if (node.discriminator !== undefined) return union(root, node.discriminator);
  if (node.const !== undefined) return { kind: "fixed", value: node.const };
  if (node.enum !== undefined) return { kind: "choice", values: node.enum };
  if (node.prefixItems !== undefined)
    return { kind: "tuple", items: node.prefixItems.map((item) => specOf(root, item)) };
  switch (node.type) {
    case "boolean":
      return { kind: "boolean" };
    case "number":
    case "integer":
      return numberSpec(node);
    case "array":
      return { kind: "list", item: specOf(root, node.items ?? {}), atLeast: node.minItems ?? 0 };
    case "object":
      return object(root, node);
    default:
      return { kind: "words", pattern: node.pattern ?? null };
  }
}

function numberSpec(node: Raw): NumberSpec {
  return {
    kind: "number",
    whole: node.type === "integer",
    minimum: node.minimum ?? null,
    maximum: node.maximum ?? null,
    above: node.exclusiveMinimum ?? null,
  };
}

function object(root: Raw, node: Raw): Spec {
  if (node.properties !== undefined) {
    const required = new Set(node.required ?? []);
    const fields = Object.entries(node.properties)
      // Deprecated fields are kept in older files but not offered.
      .filter(([, inner]) => inner.deprecated !== true)
      .map(([name, inner]) => ({
        name,
        spec: specOf(root, inner),
        required: required.has(name),
      }));
    return { kind: "object", fields };
  }
  const free = Object.values(node.patternProperties ?? {})[0] ?? node.additionalProperties;
  return { kind: "map", value: specOf(root, typeof free === "object" ? free : {}) };
}

function union(root: Raw, { propertyName, mapping }: NonNullable<Raw["discriminator"]>): Spec {
  const options: Record<string, ObjectSpec> = {};
  for (const [tag, reference] of Object.entries(mapping)) {
    const spec = specOf(root, { $ref: reference });
    if (spec.kind === "object") options[tag] = spec;
  }
  return { kind: "union", tag: propertyName, options };
}

/** Follow references, and take the side of an optional that is not null. */
function resolved(root: Raw, node: Raw): Raw {
  if (node.$ref !== undefined) {
    const name = node.$ref.split("/").at(-1) ?? "";
    return resolved(root, root.$defs?.[name] ?? {});
  }
  const option = node.anyOf?.find((one) => one.type !== "null");
  return option === undefined ? node : resolved(root, option);
}

/** The next whole number above a limit, or what lies halfway to the largest that is valid. */
function numberAbove(above: number | null, maximum: number | null): number {
  if (above === null) return 0;
  return maximum !== null && above + 1 > maximum ? (above + maximum) / 2 : above + 1;
}

/** An initial value; texts get an entry for every language of the study. */
export function blank(spec: Spec, languages: readonly string[], tag?: string): Json {
  switch (spec.kind) {
    case "texts":
      return Object.fromEntries(languages.map((language) => [language, "..."]));
    case "choice":
      return spec.values[0] ?? "";
    case "number":
      return spec.minimum ?? numberAbove(spec.above, spec.maximum);
    case "boolean":
      return false;
    case "words":
      return "";
    case "fixed":
      return spec.value;
    case "list":
      return Array.from({ length: spec.atLeast }, () => blank(spec.item, languages));
    case "map":
      return {};
    case "tuple":
      return spec.items.map((item) => blank(item, languages));
    case "union": {
      const [first] = Object.keys(spec.options);
      const option = spec.options[tag ?? first ?? ""];
      return option === undefined ? {} : blank(option, languages);
    }
    case "object":
      return Object.fromEntries(
        spec.fields
          .filter((field) => field.required)
          .map((field) => [field.name, blank(field.spec, languages)]),
      );
  }
}
