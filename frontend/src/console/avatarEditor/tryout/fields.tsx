/** Fields of the try-out: a number with its unit, and a choice among what has two names. */
import {
  type ComboboxData,
  type ComboboxParsedItem,
  NumberInput,
  type OptionsFilter,
  Select,
} from "@mantine/core";
import type { JSX } from "react";
import { isFound } from "../../avatarChanges/axes";
import classes from "./Tryout.module.css";

interface NumberFieldProps {
  readonly label: string;
  readonly unit: string;
  readonly range: readonly [least: number, greatest: number];
  readonly step?: number;
  readonly value: number;
  readonly onChange: (value: number) => void;
}

/** An empty field, or one in which something is being typed, changes nothing. */
export function NumberField({
  label,
  unit,
  range,
  step = 1,
  value,
  onChange,
}: NumberFieldProps): JSX.Element {
  const [min, max] = range;
  return (
    <NumberInput
      size="sm"
      label={label}
      suffix={` ${unit}`}
      min={min}
      max={max}
      step={step}
      value={value}
      onChange={(next) => {
        if (typeof next === "number" && next >= min && next <= max) onChange(next);
      }}
    />
  );
}

interface NamedSelectProps {
  readonly label: string;
  readonly description?: string;
  readonly data: ComboboxData;
  readonly value: string;
  readonly onChange: (value: string) => void;
}

/** A choice that is found by its words as by its own name in files, which stands beside it. */
export function NamedSelect({ onChange, description, ...rest }: NamedSelectProps): JSX.Element {
  return (
    <Select
      size="sm"
      {...rest}
      {...(description === undefined ? {} : { description })}
      inputWrapperOrder={["label", "input", "description"]}
      searchable
      filter={byNameOrCode}
      renderOption={({ option }) => <Named label={option.label} code={option.value} />}
      allowDeselect={false}
      onChange={(value) => value !== null && onChange(value)}
    />
  );
}

/** A name in the words of the joints, with its own name in files beside it. */
function Named({ label, code }: { readonly label: string; readonly code: string }): JSX.Element {
  return (
    <span className={classes.named}>
      {label}
      <code>{code}</code>
    </span>
  );
}

/** Options whose words or own name have every word of the search. */
const byNameOrCode: OptionsFilter = ({ options, search, limit }) =>
  options
    .flatMap((one): ComboboxParsedItem[] => {
      if (!("group" in one)) return isFound(search.trim(), one.label, one.value) ? [one] : [];
      const items = one.items.filter(({ label, value }) => isFound(search.trim(), label, value));
      return items.length > 0 ? [{ ...one, items }] : [];
    })
    .slice(0, limit);
