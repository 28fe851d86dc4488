/** The accounts, the invitations and the audit trail; for admins. */
import { Tabs, Text, Title } from "@mantine/core";
import type { Account } from "@shared/api/types";
import { Icon, type IconName } from "@shared/ui/Icon";
import type { JSX } from "react";
import { useLocation } from "wouter";
import { useTexts } from "../../i18n";
import { useTitle } from "../../ui/page";
import { AuditTab } from "./AuditTab";
import { InvitationsTab } from "./InvitationsTab";
import { InviteButton } from "./InviteDialog";
import classes from "./People.module.css";
import { PeopleTab } from "./PeopleTab";

const TABS = ["people", "invitations", "audit"] as const;
type Tab = (typeof TABS)[number];

const ICONS: Readonly<Record<Tab, IconName>> = {
  people: "people",
  invitations: "link",
  audit: "list",
};

interface PeoplePageProps {
  readonly account: Account;
  readonly tab: string | undefined;
}

export function PeoplePage({ account, tab: requested }: PeoplePageProps): JSX.Element {
  const { t } = useTexts();
  const [, navigate] = useLocation();
  const tab = TABS.find((name) => name === requested) ?? "people";
  useTitle(t("people.title"));
  return (
    <>
      <div className={classes.head}>
        <div>
          <Title order={1}>{t("people.title")}</Title>
          <Text c="dimmed">{t("people.lead")}</Text>
        </div>
        <InviteButton />
      </div>
      <Tabs
        value={tab}
        onChange={(value) => navigate(value === "people" ? "/people" : `/people/${value}`)}
        keepMounted={false}
      >
        <Tabs.List>
          {TABS.map((name) => (
            <Tabs.Tab key={name} value={name} leftSection={<Icon name={ICONS[name]} size={17} />}>
              {t(`people.tab.${name}`)}
            </Tabs.Tab>
          ))}
        </Tabs.List>
        <Tabs.Panel value="people" className={classes.panel ?? ""}>
          <PeopleTab account={account} />
        </Tabs.Panel>
        <Tabs.Panel value="invitations" className={classes.panel ?? ""}>
          <InvitationsTab />
        </Tabs.Panel>
        <Tabs.Panel value="audit" className={classes.panel ?? ""}>
          <AuditTab />
        </Tabs.Panel>
      </Tabs>
    </>
  );
}
