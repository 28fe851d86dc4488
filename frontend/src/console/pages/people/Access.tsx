/** Revoke somebody's access: sign out all their browsers, or deactivate the account. */
import { Button, Group, Stack, Text } from "@mantine/core";
import { type Person, people } from "@shared/api/people";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { checkSignIn } from "../../account";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { peopleQuery } from "../../queries";
import classes from "./People.module.css";

interface AccessProps {
  readonly person: Person;
  readonly isSelf: boolean;
}

export function Access({ person, isSelf }: AccessProps): JSX.Element {
  return (
    <Stack gap="lg" className={classes.access ?? ""}>
      {person.disabled_at === null && <EndLogins person={person} isSelf={isSelf} />}
      {person.disabled_at === null ? <Close person={person} /> : <Reopen person={person} />}
    </Stack>
  );
}

/** Run an action and reload the accounts and one's own sign-in, which it may have changed. */
function useAccountAction(act: () => Promise<unknown>) {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: act,
    onSuccess: async () => {
      await checkSignIn(queries);
      await queries.invalidateQueries({ queryKey: peopleQuery.queryKey });
    },
  });
}

function EndLogins({ person, isSelf }: AccessProps): JSX.Element {
  const { t } = useTexts();
  const end = useAccountAction(() => people.endLogins(person.id));
  return (
    <section>
      <Text size="sm" c="dimmed" mb={8}>
        {t("people.end.body", { name: person.username })} {isSelf && t("people.end.self")}
      </Text>
      {end.isError && <Failure error={end.error} />}
      <Group gap="sm">
        <Button
          variant="default"
          disabled={person.logins === 0}
          loading={end.isPending}
          onClick={() => end.mutate()}
        >
          {t("people.end")}
        </Button>
        <span role="status">{end.isSuccess && t("people.ended")}</span>
      </Group>
    </section>
  );
}

function Close({ person }: { readonly person: Person }): JSX.Element {
  const { t } = useTexts();
  const [sure, setSure] = useState(false);
  const close = useAccountAction(() => people.change(person.id, { closed: true }));
  const name = person.username;
  if (!sure) {
    return (
      <section>
        <Button variant="outline" color="red" onClick={() => setSure(true)}>
          {t("people.close")}
        </Button>
      </section>
    );
  }
  return (
    <section className={classes.confirm} aria-live="polite">
      <strong>{t("people.close.title", { name })}</strong>
      <Text size="sm">{t("people.close.body", { name })}</Text>
      {close.isError && <Failure error={close.error} />}
      <Group gap="sm">
        <Button color="red" loading={close.isPending} onClick={() => close.mutate()}>
          {t("people.close")}
        </Button>
        <Button variant="default" onClick={() => setSure(false)}>
          {t("action.cancel")}
        </Button>
      </Group>
    </section>
  );
}

function Reopen({ person }: { readonly person: Person }): JSX.Element {
  const { t } = useTexts();
  const reopen = useAccountAction(() => people.change(person.id, { closed: false }));
  return (
    <section>
      <Text size="sm" c="dimmed" mb={8}>
        {t("people.reopen.body", { name: person.username })}
      </Text>
      {reopen.isError && <Failure error={reopen.error} />}
      <Button variant="default" loading={reopen.isPending} onClick={() => reopen.mutate()}>
        {t("people.reopen")}
      </Button>
    </section>
  );
}
