/** The role of an account, and which studies it may see. */
import { Group, MultiSelect, Radio, Stack } from "@mantine/core";
import type { Role, StudyKeys } from "@shared/api/people";
import { inLanguage } from "@shared/text";
import { Icon } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { studiesQuery } from "../../queries";
import { ROLE_ICONS, ROLES } from "../../ui/badges";
import classes from "./People.module.css";

interface RoleChoiceProps {
  readonly role: Role;
  readonly onChange: (role: Role) => void;
}

/** The four roles side by side, so that nobody grants more than intended. */
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

/** A role with what it may and may not do, in plain words. */
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

interface StudiesChoiceProps {
  readonly studies: StudyKeys;
  readonly onChange: (studies: StudyKeys) => void;
}

/** Which studies an account may see: all, including future ones, or only these. */
export function StudiesChoice({ studies, onChange }: StudiesChoiceProps): JSX.Element {
  const { t, language } = useTexts();
  const studyList = useQuery(studiesQuery).data ?? [];
  const titles = new Map(studyList.map(({ key, titles: of }) => [key, inLanguage(of, language)]));
  // Archived studies are not listed, but stay assigned.
  const keys = [...new Set([...titles.keys(), ...(studies ?? [])])];
  return (
    <Radio.Group
      label={t("people.studies")}
      value={studies === null ? "all" : "chosen"}
      onChange={(value) => onChange(value === "all" ? null : [])}
    >
      <Stack gap="xs" mt={6}>
        <Group gap="xl">
          <Radio value="all" label={t("people.studies.all")} />
          <Radio value="chosen" label={t("people.studies.chosen")} />
        </Group>
        {studies !== null && (
          <MultiSelect
            aria-label={t("people.studies.pick")}
            placeholder={studies.length === 0 ? t("people.studies.pick") : ""}
            data={keys.map((key) => ({ value: key, label: titles.get(key) ?? key }))}
            value={[...studies]}
            onChange={onChange}
            searchable
            clearable
          />
        )}
      </Stack>
    </Radio.Group>
  );
}
