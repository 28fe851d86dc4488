/** Which studies somebody may see: all, also those to come, or these. */
import { Group, MultiSelect, Radio, Stack } from "@mantine/core";
import type { StudyKeys } from "@shared/api/people";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { studiesQuery } from "../../queries";

interface StudiesChoiceProps {
  readonly studies: StudyKeys;
  readonly onChange: (studies: StudyKeys) => void;
}

export function StudiesChoice({ studies, onChange }: StudiesChoiceProps): JSX.Element {
  const { t } = useTexts();
  const known = useQuery(studiesQuery).data ?? [];
  const titles = new Map(known.map(({ key, title }) => [key, title]));
  // Studies that were put away are not listed, but stay theirs.
  const keys = [...new Set([...titles.keys(), ...(studies ?? [])])];
  return (
    <Radio.Group
      label={t("people.studies")}
      value={studies === null ? "all" : "chosen"}
      onChange={(value) => onChange(value === "all" ? null : [])}
    >
      <Stack gap="xs" mt={6}>
        <Group gap="xl">
          <Radio value="all" label={t("people.studies.all")} />
          <Radio value="chosen" label={t("people.studies.chosen")} />
        </Group>
        {studies !== null && (
          <MultiSelect
            aria-label={t("people.studies.pick")}
            placeholder={studies.length === 0 ? t("people.studies.pick") : ""}
            data={keys.map((key) => ({ value: key, label: titles.get(key) ?? key }))}
            value={[...studies]}
            onChange={onChange}
            searchable
            clearable
          />
        )}
      </Stack>
    </Radio.Group>
  );
}
