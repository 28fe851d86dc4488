/** The four roles side by side, so that nobody gives away more than they mean to. */
import { Radio } from "@mantine/core";
import type { Role } from "@shared/api/people";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { ROLES } from "../../ui/RoleBadge";
import classes from "./People.module.css";
import { RoleFacts } from "./RoleFacts";

interface RoleChoiceProps {
  readonly role: Role;
  readonly onChange: (role: Role) => void;
}

export function RoleChoice({ role, onChange }: RoleChoiceProps): JSX.Element {
  const { t } = useTexts();
  return (
    <Radio.Group label={t("role.label")} value={role} onChange={(value) => onChange(value as Role)}>
      <div className={classes.roles}>
        {ROLES.map((value) => (
          <Radio.Card
            key={value}
            value={value}
            className={classes.card ?? ""}
            aria-label={t(`role.${value}`)}
          >
            <RoleFacts role={value} />
          </Radio.Card>
        ))}
      </div>
    </Radio.Group>
  );
}
