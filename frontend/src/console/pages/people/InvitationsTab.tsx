/** Every invitation: which are still open, and which were used. */
import { Button, Table } from "@mantine/core";
import { type Invitation, invitations } from "@shared/api/people";
import { dateTime } from "@shared/format";
import { Icon, type IconName } from "@shared/ui/Icon";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { invitationsQuery } from "../../queries";
import { RoleBadge } from "../../ui/badges";
import { EmptyState } from "../../ui/EmptyState";
import { Loaded } from "../../ui/Loaded";
import { ListTable } from "../../ui/tables";
import { actorName } from "./auditWords";
import classes from "./People.module.css";
import { Studies } from "./PeopleTab";

const COLUMNS = [
  "invitations.for",
  "role.label",
  "people.studies",
  "invitations.status",
  "invitations.made",
  "invitations.until",
] as const;

export function InvitationsTab(): JSX.Element {
  const { t } = useTexts();
  return (
    <Loaded query={useQuery({ ...invitationsQuery, refetchInterval: 15_000 })}>
      {(all) =>
        all.length === 0 ? (
          <EmptyState icon="link" title={t("invitations.empty.title")}>
            {t("invitations.empty.body")}
          </EmptyState>
        ) : (
          <ListTable columns={COLUMNS.map((column) => t(column))} hasActions>
            {all.map((invitation) => (
              <Row key={invitation.id} invitation={invitation} />
            ))}
          </ListTable>
        )
      }
    </Loaded>
  );
}

const ICONS: Readonly<Record<Invitation["status"], IconName>> = {
  open: "clock",
  used: "check",
  revoked: "close",
  expired: "stop",
};

function Row({ invitation }: { readonly invitation: Invitation }): JSX.Element {
  const { t, language } = useTexts();
  const { note, role, studies, status, used_by } = invitation;
  return (
    <Table.Tr className={status === "open" ? "" : (classes.closed ?? "")}>
      <Table.Td className={(note === "" ? classes.none : classes.name) ?? ""}>
        {note || t("invitations.noNote")}
      </Table.Td>
      <Table.Td>
        <RoleBadge role={role} />
      </Table.Td>
      <Table.Td>
        <Studies studies={studies} />
      </Table.Td>
      <Table.Td>
        <span className={classes.status}>
          <Icon name={ICONS[status]} size={15} />
          {t(`invitations.status.${status}`)}
        </span>
        {used_by !== null && (
          <span className={classes.sub}>{t("invitations.usedBy", { name: used_by })}</span>
        )}
      </Table.Td>
      <Table.Td>
        {dateTime(invitation.created_at, language)}
        <span className={classes.sub}>
          {t("invitations.by", { name: actorName(invitation.created_by) })}
        </span>
      </Table.Td>
      <Table.Td>{dateTime(invitation.expires_at, language)}</Table.Td>
      <Table.Td className={classes.rowActions ?? ""}>
        {status === "open" && <Revoke invitation={invitation} />}
      </Table.Td>
    </Table.Tr>
  );
}

function Revoke({ invitation }: { readonly invitation: Invitation }): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const revoke = useMutation({
    mutationFn: () => invitations.revoke(invitation.id),
    onSuccess: () => queries.invalidateQueries({ queryKey: invitationsQuery.queryKey }),
  });
  const note = invitation.note || t("invitations.noNote");
  return (
    <>
      {revoke.isError && <Failure error={revoke.error} />}
      <Button
        size="xs"
        variant="default"
        aria-label={t("invitations.revoke.which", { note })}
        loading={revoke.isPending}
        onClick={() => revoke.mutate()}
      >
        {t("invitations.revoke")}
      </Button>
    </>
  );
}
