/** The page of an invitation link: what it is for, and a form that creates the account. */
import { Button, Group, Loader } from "@mantine/core";
import { invitations } from "@shared/api/people";
import { type ApiError, isApiError } from "@shared/api/request";
import type { Account } from "@shared/api/types";
import { Notice } from "@shared/ui/Notice";
import { useQuery, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { navigate } from "wouter/use-hash-location";
import { signOut } from "../../account";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { useTitle } from "../../ui/page";
import { SignedOutFrame } from "../SignedOutFrame";
import classes from "./Join.module.css";
import { JoinForm } from "./JoinForm";

interface JoinPageProps {
  readonly token: string;
  readonly account: Account | null;
}

export function JoinPage({ token, account }: JoinPageProps): JSX.Element {
  const { t } = useTexts();
  useTitle(t("invited.title"));
  return (
    <SignedOutFrame title={t("invited.title")}>
      <div className={classes.body}>
        {account === null ? <Invitation token={token} /> : <SignedIn account={account} />}
      </div>
    </SignedOutFrame>
  );
}

function SignedIn({ account }: { readonly account: Account }): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const name = account.username;
  return (
    <Notice
      tone="info"
      icon="people"
      title={t("invited.other.title", { name })}
      actions={
        <Group gap="xs">
          <Button size="xs" onClick={() => void signOut(queries)}>
            {t("app.logout")}
          </Button>
          <Button size="xs" variant="default" onClick={leave}>
            {t("invited.other.stay", { name })}
          </Button>
        </Group>
      }
    >
      {t("invited.other.body")}
    </Notice>
  );
}

function Invitation({ token }: { readonly token: string }): JSX.Element {
  const query = useQuery({
    queryKey: ["invitation", token],
    queryFn: () => invitations.preview(token),
    staleTime: Number.POSITIVE_INFINITY,
    gcTime: 0,
  });
  if (query.isError) return <Refused error={query.error} onRetry={() => void query.refetch()} />;
  if (query.data === undefined)
    return (
      <div className={classes.waiting}>
        <Loader />
      </div>
    );
  return (
    <JoinForm
      token={token}
      invitation={query.data}
      onRefused={(error) => <Refused error={error} />}
    />
  );
}

type InvalidReason = "used" | "expired" | "revoked" | "unknown";

/** Why a link is not valid (any more); null for every other error. */
function whyRefused(error: unknown): InvalidReason | null {
  // A truncated link is too short for the server to look up.
  if (isApiError(error) && [404, 422].includes(error.status)) return "unknown";
  if (!isApiError(error, "gone")) return null;
  const status = (error as ApiError).value;
  return status === "used" || status === "expired" || status === "revoked" ? status : null;
}

interface RefusedProps {
  readonly error: unknown;
  readonly onRetry?: () => void;
}

function Refused({ error, onRetry }: RefusedProps): JSX.Element {
  const { t } = useTexts();
  const why = whyRefused(error);
  if (why === null) return <Failure error={error} {...(onRetry && { onRetry })} />;
  return (
    <Notice
      tone="warn"
      title={t(`invited.${why}.title`)}
      actions={
        <Button size="xs" variant="default" onClick={leave}>
          {t("invited.signIn")}
        </Button>
      }
    >
      {t(`invited.${why}.body`)}
    </Notice>
  );
}

/** The link is removed from the browser's history. */
const leave = (): void => navigate("/", { replace: true });
