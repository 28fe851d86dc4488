import { Title } from "@mantine/core";
import type { JSX } from "react";
import { useTexts } from "../i18n";

export function StudiesPage(): JSX.Element {
  const { t } = useTexts();
  return <Title order={1}>{t("app.studies")}</Title>;
}
