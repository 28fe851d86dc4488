import { Button, PasswordInput, Stack, Text, TextInput, Title } from "@mantine/core";
import { Mark } from "@shared/ui/Mark";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { signIn } from "../account";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { Echo } from "./Echo";
import classes from "./Login.module.css";

export function Login(): JSX.Element {
  const { t } = useTexts();
  return (
    <main className={classes.page}>
      <div className={classes.figure}>
        <Echo />
      </div>
      <div className={classes.form}>
        <div className={classes.brand}>
          <Mark size={32} />
          {t("app.name")}
        </div>
        <Title order={1}>{t("login.title")}</Title>
        <Text c="dimmed" mt={4} mb="xl">
          {t("login.lead")}
        </Text>
        <LoginForm />
      </div>
    </main>
  );
}

function LoginForm(): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [username, setUsername] = useState("");
  const [password, setPassword] = useState("");
  const login = useMutation({ mutationFn: () => signIn(queries, username.trim(), password) });
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        login.mutate();
      }}
    >
      <Stack>
        <TextInput
          label={t("login.username")}
          size="md"
          autoComplete="username"
          autoCapitalize="none"
          autoFocus
          required
          withAsterisk={false}
          value={username}
          onChange={(event) => setUsername(event.currentTarget.value)}
        />
        <PasswordInput
          label={t("login.password")}
          size="md"
          autoComplete="current-password"
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
          {t("login.hint")}
        </Text>
      </Stack>
    </form>
  );
}
