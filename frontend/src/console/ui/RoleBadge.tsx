/** What somebody is here, in a word and a sign. */
import type { Role } from "@shared/api/people";
import { Icon, type IconName } from "@shared/ui/Icon";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./ui.module.css";

export const ROLES: readonly Role[] = ["admin", "experimenter", "operator", "analyst"];

export const ROLE_ICONS: Readonly<Record<Role, IconName>> = {
  admin: "key",
  experimenter: "form",
  operator: "play",
  analyst: "chart",
};

export function RoleBadge({ role }: { readonly role: Role }): JSX.Element {
  const { t } = useTexts();
  return (
    <span className={classes.badge}>
      <Icon name={ROLE_ICONS[role]} size={14} />
      {t(`role.${role}`)}
    </span>
  );
}
