/** Every current and former account. */
import { Button, Table } from "@mantine/core";
import type { Person, StudyKeys } from "@shared/api/people";
import type { Account } from "@shared/api/types";
import { dateTime, day } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { useTexts } from "../../i18n";
import { peopleQuery } from "../../queries";
import { RoleBadge } from "../../ui/badges";
import { Loaded } from "../../ui/Loaded";
import { ListTable } from "../../ui/tables";
import classes from "./People.module.css";
import { PersonDrawer } from "./PersonDrawer";

const COLUMNS = [
  "people.name",
  "role.label",
  "people.studies",
  "people.lastLogin",
  "people.logins",
] as const;

export function PeopleTab({ account }: { readonly account: Account }): JSX.Element {
  const { t } = useTexts();
  const [chosen, setChosen] = useState<string | null>(null);
  return (
    <Loaded query={useQuery({ ...peopleQuery, refetchInterval: 15_000 })}>
      {(people) => (
        <>
          <ListTable columns={COLUMNS.map((column) => t(column))} hasActions>
            {people.map((person) => (
              <Row
                key={person.id}
                person={person}
                isSelf={person.id === account.id}
                onEdit={() => setChosen(person.id)}
              />
            ))}
          </ListTable>
          <PersonDrawer
            person={people.find(({ id }) => id === chosen) ?? null}
            isSelf={chosen === account.id}
            onClose={() => setChosen(null)}
          />
        </>
      )}
    </Loaded>
  );
}

interface RowProps {
  readonly person: Person;
  readonly isSelf: boolean;
  readonly onEdit: () => void;
}

function Row({ person, isSelf, onEdit }: RowProps): JSX.Element {
  const { t, language } = useTexts();
  const closed = person.disabled_at;
  return (
    <Table.Tr className={closed === null ? "" : (classes.closed ?? "")}>
      <Table.Td>
        <strong className={classes.name}>{person.username}</strong>
        {isSelf && <span className={classes.ownAccount}>{t("people.you")}</span>}
        {closed !== null && (
          <span className={classes.deactivated}>
            <Icon name="lock" size={14} />
            {t("people.closed", { date: day(closed, language) })}
          </span>
        )}
      </Table.Td>
      <Table.Td>
        <RoleBadge role={person.role} />
        <span className={classes.sub}>{t(`role.${person.role}.brief`)}</span>
      </Table.Td>
      <Table.Td>
        <Studies studies={person.studies} />
      </Table.Td>
      <Table.Td>
        {person.last_login_at === null
          ? t("people.lastLogin.never")
          : dateTime(person.last_login_at, language)}
      </Table.Td>
      <Table.Td className="numbers">
        {person.logins === 0
          ? t("people.logins.none")
          : t("people.logins.count", { count: person.logins })}
      </Table.Td>
      <Table.Td className={classes.rowActions ?? ""}>
        <Button
          size="xs"
          variant="default"
          aria-label={t("people.edit", { name: person.username })}
          onClick={onEdit}
        >
          {t("people.edit.short")}
        </Button>
      </Table.Td>
    </Table.Tr>
  );
}

export function Studies({ studies }: { readonly studies: StudyKeys }): JSX.Element {
  const { t } = useTexts();
  if (studies === null) return <>{t("people.studies.all")}</>;
  if (studies.length === 0) return <>{t("people.studies.none")}</>;
  return (
    <ul className={classes.chips}>
      {studies.map((key) => (
        <li key={key}>{key}</li>
      ))}
    </ul>
  );
}
