/** The field for whatever a place of the file can hold. */
import { Button, TagsInput } from "@mantine/core";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import classes from "../Editor.module.css";
import { useForm, useProblem, useValue } from "../formContext";
import { useLabels } from "../labels";
import { isList, isObject, type Path } from "../paths";
import { blank, type Field, type ListSpec, type ObjectSpec, type Spec } from "../schema";
import { ListField } from "./ListField";
import { BooleanField, ChoiceField, NumberField, WordsField } from "./Simple";
import { TextsField } from "./Texts";

interface SpecFieldProps {
  readonly path: Path;
  readonly spec: Spec;
  readonly label: string;
}

export function SpecField({ path, spec, label }: SpecFieldProps): JSX.Element | null {
  switch (spec.kind) {
    case "texts":
      return <TextsField path={path} label={label} />;
    case "choice":
      return <ChoiceField path={path} label={label} values={spec.values} />;
    case "number":
      return <NumberField path={path} label={label} spec={spec} />;
    case "boolean":
      return <BooleanField path={path} label={label} />;
    case "words":
      return <WordsField path={path} label={label} pattern={spec.pattern} />;
    case "tuple":
      return <TupleField path={path} spec={spec.items} label={label} />;
    case "list":
      return isWords(spec.item) ? (
        <TagsField path={path} spec={spec} label={label} />
      ) : (
        <ListField path={path} spec={spec} label={label} />
      );
    case "object":
      return (
        <fieldset className={classes.group}>
          <legend>{label}</legend>
          <ObjectFields path={path} spec={spec} />
        </fieldset>
      );
    case "union":
      return <UnionFields path={path} spec={spec} />;
    default:
      return null; // a fixed value has nothing to choose; maps of texts have a page of their own
  }
}

const isWords = (spec: Spec): boolean => spec.kind === "words" || spec.kind === "choice";

interface ObjectFieldsProps {
  readonly path: Path;
  readonly spec: ObjectSpec;
  /** Fields shown elsewhere. */
  readonly without?: readonly string[];
}

/** The fields that are there or required, and buttons that add the others. */
export function ObjectFields({ path, spec, without = [] }: ObjectFieldsProps): JSX.Element {
  const { t } = useTexts();
  const { change, languages } = useForm();
  const labels = useLabels();
  const value = useValue(path);
  const has = (field: Field) => isObject(value) && value[field.name] !== undefined;
  const fields = spec.fields.filter(
    (field) => !without.includes(field.name) && field.spec.kind !== "fixed",
  );
  const absent = fields.filter((field) => !field.required && !has(field));
  return (
    <div className={classes.fields}>
      {fields
        .filter((field) => field.required || has(field))
        .map((field) => (
          <div key={field.name} className={isWide(field.spec) ? classes.wide : classes.narrow}>
            <SpecField
              path={[...path, field.name]}
              spec={field.spec}
              label={labels.field(field.name)}
            />
            {!field.required && (
              <button
                type="button"
                className={classes.drop}
                onClick={() => change([{ path: [...path, field.name], action: "remove" }])}
              >
                {t("editor.leaveOut", { name: labels.field(field.name) })}
              </button>
            )}
          </div>
        ))}
      {absent.length > 0 && (
        <div className={classes.wide}>
          {absent.map((field) => (
            <Button
              key={field.name}
              size="compact-xs"
              variant="subtle"
              leftSection={<Icon name="add" size={14} />}
              onClick={() =>
                change([
                  {
                    path: [...path, field.name],
                    action: "set",
                    value: blank(field.spec, languages),
                  },
                ])
              }
            >
              {labels.field(field.name)}
            </Button>
          ))}
        </div>
      )}
    </div>
  );
}

const isWide = (spec: Spec): boolean =>
  spec.kind === "texts" ||
  spec.kind === "object" ||
  (spec.kind === "words" && spec.pattern === null) ||
  (spec.kind === "list" && !isWords(spec.item));

function UnionFields({
  path,
  spec,
}: {
  readonly path: Path;
  readonly spec: Extract<Spec, { kind: "union" }>;
}): JSX.Element | null {
  const value = useValue(path);
  const tag = isObject(value) ? value[spec.tag] : undefined;
  const option = typeof tag === "string" ? spec.options[tag] : undefined;
  return option === undefined ? null : <ObjectFields path={path} spec={option} />;
}

interface TupleFieldProps {
  readonly path: Path;
  readonly spec: readonly Spec[];
  readonly label: string;
}

const AXES = ["x", "y", "z"] as const;

function TupleField({ path, spec, label }: TupleFieldProps): JSX.Element {
  const problem = useProblem(path);
  return (
    <fieldset className={classes.tuple}>
      <legend>{label}</legend>
      <div className={classes.axes}>
        {spec.map((item, index) => (
          <SpecField
            // biome-ignore lint/suspicious/noArrayIndexKey: a coordinate is its place
            key={index}
            path={[...path, index]}
            spec={item}
            label={AXES[index] ?? String(index + 1)}
          />
        ))}
      </div>
      {problem !== null && <p className={classes.problem}>{problem}</p>}
    </fieldset>
  );
}

interface TagsFieldProps {
  readonly path: Path;
  readonly spec: ListSpec;
  readonly label: string;
}

/** A list of words: languages, sides, body parts. */
export function TagsField({ path, spec, label }: TagsFieldProps): JSX.Element {
  const { change, reveal } = useForm();
  const { hint } = useLabels();
  const value = useValue(path);
  const problem = useProblem(path);
  const words = isList(value) ? value.map(String) : [];
  return (
    <TagsInput
      label={label}
      description={hint(String(path.at(-1)))}
      error={problem}
      data={spec.item.kind === "choice" ? [...spec.item.values] : []}
      value={words}
      acceptValueOnBlur
      onChange={(next) => change([{ path, action: "set", value: next }])}
      onFocus={() => reveal(path)}
    />
  );
}
