/** Which sessions are looked at; people, simulated and test are never mixed. */
import { SegmentedControl } from "@mantine/core";
import type { Kind } from "@shared/api/types";
import type { JSX } from "react";
import { useTexts } from "../i18n";

export const KINDS: readonly Kind[] = ["people", "simulated", "test"];

interface KindFilterProps {
  readonly kind: Kind;
  readonly onChange: (kind: Kind) => void;
}

export function KindFilter({ kind, onChange }: KindFilterProps): JSX.Element {
  const { t } = useTexts();
  return (
    <SegmentedControl
      aria-label={t("kind.label")}
      value={kind}
      onChange={(value) => onChange(value as Kind)}
      data={KINDS.map((value) => ({ value, label: t(`kind.${value}`) }))}
    />
  );
}
