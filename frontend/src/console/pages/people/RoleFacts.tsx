/** A role with what it may and what it may not, in plain words. */
import type { Role } from "@shared/api/people";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { ROLE_ICONS } from "../../ui/RoleBadge";
import classes from "./People.module.css";

export function RoleFacts({ role }: { readonly role: Role }): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.role}>
      <span className={classes.roleName}>
        <Icon name={ROLE_ICONS[role]} size={18} />
        {t(`role.${role}`)}
      </span>
      <span className={classes.fact}>
        <Icon name="check" size={15} />
        <span>
          <span className="visually-hidden">{t("role.may")}: </span>
          {t(`role.${role}.may`)}
        </span>
      </span>
      <span className={classes.fact}>
        <Icon name="close" size={15} />
        <span>
          <span className="visually-hidden">{t("role.mayNot")}: </span>
          {t(`role.${role}.not`)}
        </span>
      </span>
    </div>
  );
}
