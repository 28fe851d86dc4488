/** An invitation's role, and the name and password to choose for the new account. */
import { Button, Stack, Text, TextInput } from "@mantine/core";
import { type InvitationLook, invitations } from "@shared/api/people";
import { isApiError } from "@shared/api/request";
import { dateTime } from "@shared/format";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { navigate } from "wouter/use-hash-location";
import { startSession } from "../../account";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { useSingleSubmit } from "../../ui/useSingleSubmit";
import { fieldErrors, NewPassword, NOTHING_TYPED } from "../account/NewPassword";
import { checkPassword, isGood } from "../account/passwordRule";
import { RoleFacts } from "../people/RoleAndStudies";
import classes from "./Join.module.css";

interface JoinFormProps {
  readonly token: string;
  readonly invitation: InvitationLook;
  /** What to show if the link has been used meanwhile. */
  readonly onRefused: (error: unknown) => JSX.Element;
}

export function JoinForm({ token, invitation, onRefused }: JoinFormProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [username, setUsername] = useState("");
  const [typed, setTyped] = useState(NOTHING_TYPED);
  const good = isGood(checkPassword(typed.password, typed.repeated, username.trim()));
  const accept = useMutation({
    mutationFn: () => invitations.accept(token, username.trim(), typed.password),
    onSuccess: ({ account }) => {
      navigate("/", { replace: true });
      startSession(queries, account);
    },
  });
  const submit = useSingleSubmit(accept);
  if (isApiError(accept.error, "gone")) return onRefused(accept.error);
  const errors = fieldErrors(accept.error);
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        if (good && username.trim() !== "") submit();
      }}
    >
      <Stack>
        <Offer look={invitation} />
        <TextInput
          label={t("invited.username")}
          description={t("invited.username.hint")}
          autoComplete="username"
          autoCapitalize="none"
          autoFocus
          required
          withAsterisk={false}
          maxLength={80}
          error={errors.username}
          value={username}
          onChange={(event) => setUsername(event.currentTarget.value)}
        />
        <NewPassword
          label={t("password.first")}
          username={username}
          value={typed}
          error={errors.password}
          onChange={setTyped}
        />
        {errors.other !== null && <Failure error={errors.other} />}
        <Button
          type="submit"
          size="md"
          loading={accept.isPending}
          disabled={!good || username.trim() === ""}
        >
          {t("invited.submit")}
        </Button>
      </Stack>
    </form>
  );
}

function Offer({ look }: { readonly look: InvitationLook }): JSX.Element {
  const { t, language } = useTexts();
  return (
    <section className={classes.promise} aria-label={t("invited.as")}>
      <span className={classes.kicker}>{t("invited.as")}</span>
      <RoleFacts role={look.role} />
      <Text size="sm" c="dimmed">
        {look.note !== "" && (
          <span className={classes.note}>{t("invited.note", { note: look.note })}</span>
        )}
        {t("invited.until", { date: dateTime(look.expires_at, language) })}
      </Text>
    </section>
  );
}
