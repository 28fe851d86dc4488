/** A form to read a file with another unit or another up axis. */
import { Button, NumberInput, Select } from "@mantine/core";
import { type Capture, captures, type ReadingChoice } from "@shared/api/captures";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import classes from "./Capture.module.css";
import { captureQuery, readingOf } from "./queries";

const UNITS = { mm: 0.001, cm: 0.01, m: 1, inch: 0.0254, foot: 0.3048 } as const;
type Unit = keyof typeof UNITS;
const NAMES = Object.keys(UNITS) as Unit[];
const UPS = ["x", "y", "z"] as const;

const unitOf = (metres: number | null): Unit | "auto" | "other" =>
  metres === null ? "auto" : (NAMES.find((name) => UNITS[name] === metres) ?? "other");

export function ReadingForm({ capture }: { readonly capture: Capture }): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const now = readingOf(capture);
  const [unit, setUnit] = useState(unitOf(now.metres_per_unit));
  const [metres, setMetres] = useState<number | string>(now.metres_per_unit ?? 0.01);
  const [up, setUp] = useState<(typeof UPS)[number] | "auto">(now.up ?? "auto");
  const choice: ReadingChoice = {
    metres_per_unit: unit === "auto" ? null : unit === "other" ? Number(metres) : UNITS[unit],
    up: up === "auto" ? null : up,
  };
  const read = useMutation({
    mutationFn: () => captures.change(capture.id, { reading: choice }),
    onSuccess: async (changed) => {
      await queries.invalidateQueries({ queryKey: ["captures"], refetchType: "none" });
      queries.setQueryData(captureQuery(capture.id).queryKey, changed);
      void queries.invalidateQueries({ queryKey: ["captures", capture.id, "joint-map"] });
    },
  });
  const isOther = choice.metres_per_unit !== now.metres_per_unit || choice.up !== now.up;
  return (
    <form
      className={classes.reading}
      onSubmit={(event) => {
        event.preventDefault();
        read.mutate();
      }}
    >
      <Select
        size="sm"
        label={t("conventions.unit")}
        allowDeselect={false}
        value={unit}
        onChange={(value) => setUnit((value ?? "auto") as typeof unit)}
        data={(["auto", ...NAMES, "other"] as const).map((value) => ({
          value,
          label: t(`conventions.unit.${value}`),
        }))}
      />
      {unit === "other" && (
        <NumberInput
          size="sm"
          label={t("conventions.unit.metres")}
          min={0.000_001}
          max={1000}
          step={0.001}
          value={metres}
          onChange={setMetres}
        />
      )}
      <Select
        size="sm"
        label={t("conventions.up")}
        allowDeselect={false}
        value={up}
        onChange={(value) => setUp((value ?? "auto") as typeof up)}
        data={[
          { value: "auto", label: t("conventions.up.auto") },
          ...UPS.map((value) => ({ value, label: value })),
        ]}
      />
      {read.isError && <Failure error={read.error} />}
      {read.isSuccess && !isOther && (
        <Notice
          tone="info"
          icon="check"
          title={t("conventions.done", {
            length: capture.summary.conventions.length.value,
            axes: capture.summary.conventions.axes.value,
          })}
        />
      )}
      <Button type="submit" variant="default" disabled={!isOther} loading={read.isPending}>
        {t("conventions.read")}
      </Button>
    </form>
  );
}
