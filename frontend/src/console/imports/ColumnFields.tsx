/**
 * Which instrument a file answers, and which columns contain the participant, the condition and the
 * time.
 */
import { NumberInput, Select } from "@mantine/core";
import type { ImportMapping, ImportPreview } from "@shared/api/imports";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { instrumentsQuery } from "../queries";
import classes from "./Imports.module.css";

interface FieldsProps {
  readonly preview: ImportPreview;
  readonly mapping: ImportMapping;
  readonly onChange: (part: Partial<ImportMapping>) => void;
  readonly onPreview: (instrument: string, headerRows: number | null) => void;
}

const ORDERS = ["iso", "day_first", "month_first"] as const;

export function ColumnFields({ preview, mapping, onChange, onPreview }: FieldsProps): JSX.Element {
  const { t } = useTexts();
  const instruments = useQuery(instrumentsQuery).data ?? [];
  const columns = preview.columns.map(({ name }) => name);
  return (
    <div className={classes.fields}>
      <Select
        label={t("imports.instrument")}
        allowDeselect={false}
        searchable
        data={instruments.map(({ key }) => key)}
        value={preview.instrument}
        onChange={(value) => value !== null && onPreview(value, null)}
      />
      <Select
        label={t("imports.participant")}
        searchable
        data={columns}
        value={mapping.participant || null}
        onChange={(value) => onChange({ participant: value ?? "" })}
      />
      <Select
        label={t("imports.condition")}
        placeholder={t("imports.noColumn")}
        searchable
        clearable
        disabled={mapping.sets.length > 1}
        data={columns}
        value={mapping.condition}
        onChange={(value) =>
          onChange({
            condition: value,
            sets: mapping.sets.map((one) => ({ ...one, condition: null })),
          })
        }
      />
      <Select
        label={t("imports.date")}
        placeholder={t("imports.noColumn")}
        searchable
        clearable
        data={columns}
        value={mapping.date}
        onChange={(value) => onChange({ date: value })}
      />
      {mapping.date !== null && (
        <Select
          label={t("imports.dateOrder")}
          allowDeselect={false}
          data={ORDERS.map((value) => ({ value, label: t(`imports.dateOrder.${value}`) }))}
          value={mapping.date_order}
          onChange={(value) =>
            onChange({ date_order: ORDERS.find((one) => one === value) ?? "iso" })
          }
        />
      )}
      <NumberInput
        label={t("imports.headerRows")}
        min={1}
        max={5}
        value={preview.header_rows}
        onChange={(value) =>
          typeof value === "number" &&
          value >= 1 &&
          value <= 5 &&
          onPreview(preview.instrument, value)
        }
      />
    </div>
  );
}
