/** A field for one answer, by the kind of its item; null omits it. */
import { NumberInput, Select, Textarea } from "@mantine/core";
import type { AnswerValue, Form } from "@shared/api/rights";
import type { Item } from "@shared/api/types";
import { inLanguage } from "@shared/text";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { labelAt, scaleOf, stepsOf } from "./answerText";

interface AnswerFieldProps {
  readonly form: Form;
  readonly item: Item;
  readonly value: AnswerValue;
  readonly onChange: (value: AnswerValue) => void;
}

export function AnswerField({ form, item, value, onChange }: AnswerFieldProps): JSX.Element {
  const { t } = useTexts();
  const label = t("answers.new");
  const placeholder = t("answers.leftOut");
  if (item.type === "text") {
    return (
      <Textarea
        label={label}
        placeholder={placeholder}
        autosize
        minRows={2}
        maxLength={item.max_length ?? 4000}
        value={value === null ? "" : String(value)}
        onChange={({ currentTarget }) =>
          onChange(currentTarget.value === "" ? null : currentTarget.value)
        }
      />
    );
  }
  if (item.type === "integer" || item.type === "number") {
    const limits = {
      ...(item.minimum == null ? {} : { min: item.minimum }),
      ...(item.maximum == null ? {} : { max: item.maximum }),
    };
    return (
      <NumberInput
        label={label}
        placeholder={placeholder}
        {...limits}
        clampBehavior="none"
        allowDecimal={item.type === "number"}
        suffix={item.unit ? ` ${item.unit}` : ""}
        value={value === null ? "" : Number(value)}
        onChange={(next) => onChange(next === "" ? null : Number(next))}
      />
    );
  }
  return <Choice form={form} item={item} value={value} onChange={onChange} />;
}

/** A choice of a few words: scales, choices, yes and no. */
function Choice({ form, item, value, onChange }: AnswerFieldProps): JSX.Element {
  const { t, language } = useTexts();
  const scale = scaleOf(form, item);
  const options =
    item.type === "boolean"
      ? [
          { value: "1", label: t("answers.yes") },
          { value: "0", label: t("answers.no") },
        ]
      : item.type === "choice"
        ? (item.choices ?? []).map((one) => ({
            value: one.key,
            label: inLanguage(one.label, language),
          }))
        : stepsOf(scale ?? { minimum: 1, maximum: 7, labels: [] }).map((step) => {
            const label = labelAt(scale, step, language);
            return {
              value: String(step),
              label: label === null ? `${step}` : `${step} (${label})`,
            };
          });
  const chosen = (next: string | null): AnswerValue => {
    if (next === null) return null;
    if (item.type === "boolean") return next === "1";
    return item.type === "choice" ? next : Number(next);
  };
  return (
    <Select
      label={t("answers.new")}
      placeholder={t("answers.leftOut")}
      clearable
      clearButtonProps={{ "aria-label": t("answers.takeOut") }}
      data={options}
      value={value === null ? null : String(typeof value === "boolean" ? Number(value) : value)}
      onChange={(next) => onChange(chosen(next))}
    />
  );
}
