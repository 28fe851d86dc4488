/** The mapping of a file's words: answers in words, numbers on another scale, conditions. */
import { NumberInput, Select, Title } from "@mantine/core";
import type { ImportMapping } from "@shared/api/imports";
import type { StudyDetail } from "@shared/api/types";
import { inLanguage } from "@shared/text";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./Imports.module.css";

interface WordsProps {
  readonly study: StudyDetail;
  readonly words: readonly string[];
  readonly conditions: readonly string[];
  readonly mapping: ImportMapping;
  readonly onChange: (part: Partial<ImportMapping>) => void;
}

export function WordFields({
  study,
  words,
  conditions,
  mapping,
  onChange,
}: WordsProps): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.columns}>
      <section aria-label={t("imports.numbers")}>
        <Title order={3} size="h5">
          {t("imports.numbers")}
        </Title>
        <div className={classes.formula}>
          <span>{t("imports.answerIs")}</span>
          <NumberInput
            size="xs"
            w={84}
            aria-label={t("imports.multiply")}
            value={mapping.multiply}
            onChange={(value) =>
              typeof value === "number" && value !== 0 && onChange({ multiply: value })
            }
          />
          <span>{t("imports.timesNumberPlus")}</span>
          <NumberInput
            size="xs"
            w={84}
            aria-label={t("imports.add")}
            value={mapping.add}
            onChange={(value) => typeof value === "number" && onChange({ add: value })}
          />
        </div>
        {words.map((word) => (
          <div key={word} className={classes.pair}>
            <span>“{word}”</span>
            <NumberInput
              size="xs"
              w={84}
              aria-label={t("imports.wordIs", { word })}
              value={mapping.words[word] ?? ""}
              onChange={(value) => onChange({ words: withWord(mapping.words, word, value) })}
            />
          </div>
        ))}
      </section>
      {conditions.length > 0 && (
        <section aria-label={t("imports.conditions")}>
          <Title order={3} size="h5">
            {t("imports.conditions")}
          </Title>
          {conditions.map((word) => (
            <ConditionField
              key={word}
              study={study}
              word={word}
              mapping={mapping}
              onChange={onChange}
            />
          ))}
        </section>
      )}
    </div>
  );
}

interface ConditionProps extends Pick<WordsProps, "study" | "mapping" | "onChange"> {
  readonly word: string;
}

function ConditionField({ study, word, mapping, onChange }: ConditionProps): JSX.Element {
  const { t, language } = useTexts();
  const conditions = study.protocol?.conditions ?? [];
  return (
    <div className={classes.pair}>
      <span>“{word}”</span>
      <Select
        size="xs"
        aria-label={t("imports.conditionIs", { word })}
        placeholder={t("imports.ownWord")}
        clearable
        data={conditions.map(({ key, label }) => ({
          value: key,
          label: inLanguage(label, language),
        }))}
        value={mapping.conditions[word] ?? null}
        onChange={(value) => {
          const others = Object.entries(mapping.conditions).filter(([one]) => one !== word);
          const conditions = Object.fromEntries(others);
          onChange({ conditions: value === null ? conditions : { ...conditions, [word]: value } });
        }}
      />
    </div>
  );
}

function withWord(
  words: Readonly<Record<string, number>>,
  word: string,
  value: string | number,
): Record<string, number> {
  const others = Object.fromEntries(Object.entries(words).filter(([one]) => one !== word));
  return typeof value === "number" ? { ...others, [word]: value } : others;
}
