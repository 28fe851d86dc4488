/** The choice between bodies with skin and stick figures, remembered by the browser. */
import { SegmentedControl } from "@mantine/core";
import { useLocalStorage } from "@mantine/hooks";
import type { JSX } from "react";
import { useTexts } from "../i18n";

export type Drawn = "skin" | "skeleton";
const DRAWN: readonly Drawn[] = ["skin", "skeleton"];

export function useDrawnAs(): readonly [drawn: Drawn, setDrawn: (drawn: Drawn) => void] {
  const [drawn, setDrawn] = useLocalStorage<Drawn>({ key: "reembody.drawn", defaultValue: "skin" });
  return [drawn, setDrawn];
}

export function DrawnAs({ className }: { readonly className?: string }): JSX.Element {
  const { t } = useTexts();
  const [drawn, setDrawn] = useDrawnAs();
  return (
    <SegmentedControl
      size="xs"
      className={className ?? ""}
      aria-label={t("bodyView.drawn")}
      value={drawn}
      onChange={(value) => setDrawn(value as Drawn)}
      data={DRAWN.map((value) => ({ value, label: t(`bodyView.drawn.${value}`) }))}
    />
  );
}
