/** Fields that forms about walks share: a name, a scene, whole numbers. */
import { NumberInput, Select, TextInput } from "@mantine/core";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { scenesQuery } from "./queries";
import classes from "./Walking.module.css";
import { OPEN_FLOOR } from "./walkedScenes";

interface NameFieldProps {
  readonly value: string;
  readonly onChange: (value: string) => void;
}

export function NameField({ value, onChange }: NameFieldProps): JSX.Element {
  const { t } = useTexts();
  return (
    <TextInput
      label={t("walking.name")}
      required
      maxLength={200}
      value={value}
      onChange={(event) => onChange(event.currentTarget.value)}
    />
  );
}

interface SceneFieldProps {
  readonly label: string;
  readonly description?: string;
  readonly placeholder: string;
  /** Whether the floor without obstacles is a choice of its own, beside none. */
  readonly withOpenFloor?: boolean;
  readonly value: string | null;
  readonly onChange: (key: string | null) => void;
}

export function SceneField({ withOpenFloor = false, ...props }: SceneFieldProps): JSX.Element {
  const { t } = useTexts();
  const scenes = useQuery(scenesQuery).data ?? [];
  const open = withOpenFloor ? [{ value: OPEN_FLOOR, label: t("walking.model.scene.open") }] : [];
  return (
    <Select
      {...props}
      data={[...open, ...scenes.map((one) => ({ value: one.key, label: one.title }))]}
      clearable
    />
  );
}

type OptionName = "steps" | "k" | "entries" | "people" | "repetitions" | "seed";

interface WholeNumbersProps<Name extends OptionName> {
  readonly fields: readonly { readonly name: Name; readonly min: number; readonly max: number }[];
  readonly values: Readonly<Record<Name, number>>;
  /** What a field means, in a line. */
  readonly hint?: (name: Name) => string;
  readonly onChange: (name: Name, value: number) => void;
}

export function WholeNumbers<Name extends OptionName>({
  fields,
  values,
  hint,
  onChange,
}: WholeNumbersProps<Name>): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.choices}>
      {fields.map(({ name, min, max }) => (
        <NumberInput
          key={name}
          label={t(`walking.option.${name}`)}
          description={hint?.(name)}
          value={values[name]}
          min={min}
          max={max}
          allowDecimal={false}
          onChange={(value) => typeof value === "number" && onChange(name, value)}
        />
      ))}
    </div>
  );
}
