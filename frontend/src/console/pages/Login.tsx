import { Button, PasswordInput, Stack, Text, TextInput } from "@mantine/core";
import type { Account } from "@shared/api/types";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { signIn } from "../account";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { useFormSubmit } from "../ui/useSingleSubmit";
import { SignedOutFrame } from "./SignedOutFrame";

/** The sign-in page; `ended` is the account whose sign-in has expired. */
export function Login({ ended = null }: { readonly ended?: Account | null }): JSX.Element {
  const { t } = useTexts();
  return (
    <SignedOutFrame title={t("login.title")}>
      <Text c="dimmed" mt={4} mb="xl">
        {t("login.lead")}
      </Text>
      {ended !== null && (
        <div style={{ marginBottom: 20 }}>
          <Notice tone="warn" icon="lock" title={t("login.ended.title")}>
            {t("login.ended.body")}
          </Notice>
        </div>
      )}
      <LoginForm username={ended?.username ?? ""} />
    </SignedOutFrame>
  );
}

function LoginForm({ username: expiredName }: { readonly username: string }): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [username, setUsername] = useState(expiredName);
  const [password, setPassword] = useState("");
  const login = useMutation({ mutationFn: () => signIn(queries, username.trim(), password) });
  const submit = useFormSubmit(login);
  return (
    <form onSubmit={submit}>
      <Stack>
        <TextInput
          label={t("login.username")}
          size="md"
          autoComplete="username"
          autoCapitalize="none"
          autoFocus={expiredName === ""}
          required
          withAsterisk={false}
          value={username}
          onChange={(event) => setUsername(event.currentTarget.value)}
        />
        <PasswordInput
          label={t("login.password")}
          size="md"
          autoComplete="current-password"
          autoFocus={expiredName !== ""}
          required
          withAsterisk={false}
          value={password}
          onChange={(event) => setPassword(event.currentTarget.value)}
        />
        {login.isError && <Failure error={login.error} />}
        <Button type="submit" size="md" loading={login.isPending} mt="xs">
          {t("login.submit")}
        </Button>
        <Text size="sm" c="dimmed">
          {t("login.hint")} {t("login.forgotten")}
        </Text>
      </Stack>
    </form>
  );
}
