/** What a session's data are: people's, a simulation's, a test's, or an expert's. Shape and word, not colour alone. */
import type { Kind } from "@shared/api/types";
import { Icon, type IconName } from "@shared/ui/Icon";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./ui.module.css";

const ICONS: Readonly<Record<Kind, IconName>> = {
  people: "people",
  simulated: "body",
  test: "flag",
  expert: "talk",
};

export function KindBadge({ kind }: { readonly kind: Kind }): JSX.Element {
  const { t } = useTexts();
  return (
    <span className={`${classes.badge} ${classes[kind]}`}>
      <Icon name={ICONS[kind]} size={14} />
      {t(`kind.${kind}`)}
    </span>
  );
}
