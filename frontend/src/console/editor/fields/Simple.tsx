/** Fields of one value: words, numbers, choices, yes or no. */
import {
  Autocomplete,
  ColorInput,
  NumberInput,
  Select,
  Switch,
  Textarea,
  TextInput,
} from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { Attention } from "../../bodies/Attention";
import { bodiesQuery } from "../../bodies/queries";
import { useTexts } from "../../i18n";
import { useCommitted, useForm, useLabels, useProblem, useValue } from "../formContext";
import { isList, isObject, type Json, type Path } from "../paths";
import type { NumberSpec } from "../schema";

interface FieldProps {
  readonly path: Path;
  readonly label: string;
}

const shown = (value: Json | undefined): string =>
  value === undefined || value === null || typeof value === "object" ? "" : String(value);

function useSet(path: Path): (value: Json) => void {
  const { change } = useForm();
  return (value) => change([{ path, action: "set", value }]);
}

export function WordsField({
  path,
  label,
  pattern,
}: FieldProps & { readonly pattern: string | null }) {
  const value = useValue(path);
  const set = useSet(path);
  const problem = useProblem(path);
  const { reveal } = useForm();
  const { hint } = useLabels();
  const field = useCommitted(shown(value), set);
  const existingKeys = useExistingKeys(path);
  const common = {
    label,
    description: hint(String(path.at(-1))),
    error: problem,
    value: field.value,
    onBlur: field.onBlur,
    onFocus: () => reveal(path),
  };
  if (pattern?.includes("[0-9a-f]{6}") === true)
    return (
      <ColorInput
        {...common}
        format="hex"
        withEyeDropper={false}
        onChange={(text) => field.onChange(text)}
      />
    );
  if (existingKeys !== null)
    return (
      <>
        <Autocomplete
          {...common}
          data={[...existingKeys]}
          onChange={(text) => field.onChange(text)}
        />
        {isBodyOfCondition(path) && <BodyAttention name={field.value} />}
      </>
    );
  const onChange = (event: { currentTarget: { value: string } }) =>
    field.onChange(event.currentTarget.value);
  // Keys have a pattern and are short; a text without a pattern is prose.
  return pattern === null ? (
    <Textarea {...common} autosize maxRows={8} onChange={onChange} />
  ) : (
    <TextInput {...common} onChange={onChange} />
  );
}

const isBodyOfCondition = (path: Path): boolean =>
  path[0] === "conditions" && path.at(-1) === "body";

/** What to consider about the chosen body, where it is chosen. */
function BodyAttention({ name }: { readonly name: string }): JSX.Element | null {
  const body = useQuery(bodiesQuery).data?.humanoids.find((one) => one.name === name);
  return body === undefined ? null : <Attention body={body} />;
}

/** The keys that exist elsewhere in the file or in the library, for fields that refer to one. */
function useExistingKeys(path: Path): readonly string[] | null {
  const { tree, instruments } = useForm();
  const isBody = isBodyOfCondition(path);
  const bodies = useQuery({ ...bodiesQuery, enabled: isBody });
  if (isBody) return (bodies.data?.humanoids ?? []).flatMap(({ name }) => name ?? []).toSorted();
  switch (path.at(-1)) {
    case "text":
      return isObject(tree.texts) ? Object.keys(tree.texts) : [];
    case "instrument":
    case "questionnaire":
      return instruments;
    case "default": {
      const palettes = isObject(tree.appearance) ? tree.appearance.palettes : undefined;
      return isList(palettes)
        ? palettes.flatMap((one) => (isObject(one) ? shown(one.key) : []))
        : null;
    }
    default:
      return null;
  }
}

interface NewKey {
  /** What a key is called where one is added. */
  readonly label: string;
  /** The keys that the library knows, to choose from. */
  readonly known: readonly string[];
}

/** How a key is added to a map: an instrument of rehearsed answers, or one of its Likert items. */
export function useNewKey(path: Path, label: string): NewKey {
  const { t } = useTexts();
  const { instruments } = useForm();
  const isSimulation = path[0] === "simulation";
  const instrument = isSimulation && path.length === 3 ? String(path[2]) : "";
  if (isSimulation && path.length === 2) {
    return { label: t("editor.newInstrument"), known: instruments };
  }
  if (instrument !== "") return { label: t("editor.newItem", { name: instrument }), known: [] };
  return { label: t("editor.newKey", { label }), known: [] };
}

export function NumberField({
  path,
  label,
  spec,
}: FieldProps & { readonly spec: NumberSpec }): JSX.Element {
  const value = useValue(path);
  const set = useSet(path);
  const problem = useProblem(path);
  const { reveal } = useForm();
  const { hint } = useLabels();
  const field = useCommitted(shown(value), (text) => {
    const parsed = Number(text);
    set(text.trim() === "" || !Number.isFinite(parsed) ? text : parsed);
  });
  return (
    <NumberInput
      label={label}
      description={hint(String(path.at(-1)))}
      error={problem}
      value={field.value}
      allowDecimal={!spec.whole}
      step={spec.whole ? 1 : 0.01}
      hideControls={!spec.whole}
      onChange={(next) => field.onChange(String(next))}
      onBlur={field.onBlur}
      onFocus={() => reveal(path)}
    />
  );
}

export function ChoiceField({
  path,
  label,
  values,
}: FieldProps & { readonly values: readonly string[] }) {
  const value = useValue(path);
  const set = useSet(path);
  const problem = useProblem(path);
  const { reveal } = useForm();
  const labels = useLabels();
  return (
    <Select
      label={label}
      description={labels.hint(String(path.at(-1)))}
      error={problem}
      data={values.map((one) => ({ value: one, label: labels.value(one) }))}
      value={shown(value) || null}
      allowDeselect={false}
      onChange={(next) => next !== null && set(next)}
      onFocus={() => reveal(path)}
    />
  );
}

export function BooleanField({ path, label }: FieldProps): JSX.Element {
  const value = useValue(path);
  const set = useSet(path);
  const problem = useProblem(path);
  const { hint } = useLabels();
  return (
    <Switch
      label={label}
      description={hint(String(path.at(-1)))}
      error={problem}
      checked={value === true}
      onChange={(event) => set(event.currentTarget.checked)}
    />
  );
}
