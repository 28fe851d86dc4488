/** What the panels of the editor share: what they are given, and how they show a choice. */
import { SegmentedControl } from "@mantine/core";
import type { JSX } from "react";
import { type Key, useTexts } from "../i18n";
import type { Operation } from "./api";
import type { AvatarFile } from "./axes";
import classes from "./Editor.module.css";

export interface PanelProps {
  readonly configuration: AvatarFile;
  readonly edit: (operations: readonly Operation[], label: string) => Promise<boolean>;
  readonly isReadOnly: boolean;
}

/** For panels that mark what was changed. */
export interface ComparedPanelProps extends PanelProps {
  /** The saved version, from which changes count. */
  readonly base: AvatarFile;
}

interface ChoiceProps<Value extends string> {
  readonly name: "hips" | "targets";
  readonly value: Value;
  readonly values: readonly Value[];
  /** What the saved version has. */
  readonly before: Value;
  readonly isReadOnly: boolean;
  readonly onChange: (value: Value) => void;
}

/** One of two ways in which a body is driven, with what the chosen one means. */
export function Choice<Value extends string>(props: ChoiceProps<Value>): JSX.Element {
  const { name, value, values, before, isReadOnly, onChange } = props;
  const { t } = useTexts();
  return (
    <div>
      <span className={classes.fieldName}>{t(`avatars.${name}`)}</span>
      <SegmentedControl
        size="xs"
        aria-label={t(`avatars.${name}`)}
        disabled={isReadOnly}
        value={value}
        onChange={(one) => onChange(one as Value)}
        data={values.map((one) => ({ value: one, label: t(`avatars.${name}.${one}` as Key) }))}
      />
      <Before isChanged={value !== before} value={t(`avatars.${name}.${before}` as Key)} />
      <p className={classes.soft}>{t(`avatars.${name}.${value}.means` as Key)}</p>
    </div>
  );
}

interface BeforeProps {
  readonly isChanged: boolean;
  readonly value: string;
}

/** What a changed value is in the saved version. */
export function Before({ isChanged, value }: BeforeProps): JSX.Element | null {
  const { t } = useTexts();
  return isChanged ? (
    <span className={classes.before}>{t("avatars.wasNow", { value })}</span>
  ) : null;
}
