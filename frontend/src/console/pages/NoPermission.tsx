/** The page for addresses that lead nowhere or are not for the account's role. */
import { Button } from "@mantine/core";
import type { JSX, ReactNode } from "react";
import { Link } from "wouter";
import { useAccount } from "../account";
import { useTexts } from "../i18n";
import { type Permission, usePermissions } from "../permissions";
import { EmptyState } from "../ui/EmptyState";
import { useTitle } from "../ui/page";

interface OnlyProps {
  readonly permission: Permission;
  readonly children: ReactNode;
}

/** Show a page to accounts with the permission, and a calm explanation to others. */
export function RequirePermission({ permission, children }: OnlyProps): JSX.Element {
  const can = usePermissions();
  if (can(permission)) return <>{children}</>;
  return (
    <div style={{ maxWidth: 1240, margin: "0 auto", padding: "28px 24px" }}>
      <NoPermission isPage />
    </div>
  );
}

interface NoPermissionProps {
  /** Whether nothing else is on the page, such as the title of a study. */
  readonly isPage?: boolean;
}

export function NoPermission({ isPage = false }: NoPermissionProps): JSX.Element {
  const { t } = useTexts();
  const account = useAccount().data;
  return (
    <EmptyState
      isPage={isPage}
      icon="lock"
      title={t("forbidden.title")}
      action={
        <Button component={Link} href="/" variant="default">
          {t("forbidden.back")}
        </Button>
      }
    >
      {account != null &&
        t("forbidden.body", { name: account.username, role: t(`role.${account.role}`) })}
    </EmptyState>
  );
}

export function PageNotFound(): JSX.Element {
  const { t } = useTexts();
  useTitle(t("nowhere.title"));
  return (
    <EmptyState
      isPage
      icon="info"
      title={t("nowhere.title")}
      action={
        <Button component={Link} href="/" variant="default">
          {t("forbidden.back")}
        </Button>
      }
    >
      {t("nowhere.body")}
    </EmptyState>
  );
}
