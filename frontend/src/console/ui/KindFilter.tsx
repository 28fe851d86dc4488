/** The filter by kind of session; participants, simulated and test sessions are never mixed. */
import { SegmentedControl } from "@mantine/core";
import type { DataKind, Kind } from "@shared/api/types";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./ui.module.css";

const DATA_KINDS: readonly DataKind[] = ["people", "simulated", "test"];
/** All kinds: experts' sessions are listed with the others, but never analysed. */
export const KINDS: readonly Kind[] = [...DATA_KINDS, "expert"];

interface KindFilterProps {
  readonly kind: DataKind;
  readonly onChange: (kind: DataKind) => void;
}

export function KindFilter({ kind, onChange }: KindFilterProps): JSX.Element {
  const { t } = useTexts();
  return (
    <SegmentedControl
      className={classes.onScreen ?? ""}
      aria-label={t("kind.label")}
      value={kind}
      onChange={(value) => onChange(value as DataKind)}
      data={DATA_KINDS.map((value) => ({ value, label: t(`kind.${value}`) }))}
    />
  );
}
