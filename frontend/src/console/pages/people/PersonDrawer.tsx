/** One account: its role, its studies, and revoking its access. */
import { Button, Drawer, Stack } from "@mantine/core";
import { type Person, people } from "@shared/api/people";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { peopleQuery } from "../../queries";
import { Access } from "./Access";
import { RoleChoice, StudiesChoice } from "./RoleAndStudies";

interface PersonDrawerProps {
  readonly person: Person | null;
  readonly isSelf: boolean;
  readonly onClose: () => void;
}

export function PersonDrawer({ person, isSelf, onClose }: PersonDrawerProps): JSX.Element {
  const { t } = useTexts();
  return (
    <Drawer
      opened={person !== null}
      onClose={onClose}
      position="right"
      size={560}
      title={person?.username ?? ""}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      {person !== null && (
        <Stack gap="xl">
          {isSelf && <Notice tone="info">{t("people.self")}</Notice>}
          <Rights key={person.id} person={person} />
          <Access person={person} isSelf={isSelf} />
        </Stack>
      )}
    </Drawer>
  );
}

function Rights({ person }: { readonly person: Person }): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [role, setRole] = useState(person.role);
  const [studies, setStudies] = useState(person.studies);
  const others = String(studies) !== String(person.studies);
  const another = role !== person.role;
  // Send only what has changed, so that the audit trail records no more than that.
  const change = useMutation({
    mutationFn: () =>
      people.change(person.id, { ...(another && { role }), ...(others && { studies }) }),
    onSuccess: async () => {
      await queries.invalidateQueries({ queryKey: peopleQuery.queryKey });
      // One's own role may have changed.
      await queries.invalidateQueries({ queryKey: ["account"], exact: true });
    },
  });
  const same = !another && !others;
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        change.mutate();
      }}
    >
      <Stack>
        <RoleChoice role={role} onChange={setRole} />
        <StudiesChoice studies={studies} onChange={setStudies} />
        {change.isError && <Failure error={change.error} />}
        {change.isSuccess && same && <Notice tone="info" icon="check" title={t("people.saved")} />}
        <Button
          type="submit"
          disabled={same}
          loading={change.isPending}
          style={{ justifySelf: "start", alignSelf: "start" }}
        >
          {t("people.save")}
        </Button>
      </Stack>
    </form>
  );
}
