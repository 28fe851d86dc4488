/** The page Walking: querying a model, the models and their walks, and the scenes. */
import { Tabs, Text, Title } from "@mantine/core";
import { Icon, type IconName } from "@shared/ui/Icon";
import type { JSX } from "react";
import { useLocation } from "wouter";
import { useTexts } from "../i18n";
import { useTitle } from "../ui/page";
import { ModelsTab } from "./ModelsTab";
import { QueryTab } from "./QueryTab";
import { ScenesTab } from "./ScenesTab";
import classes from "./Walking.module.css";

const TABS = ["ask", "models", "scenes"] as const;
type Tab = (typeof TABS)[number];

const ICONS: Readonly<Record<Tab, IconName>> = { ask: "clock", models: "chart", scenes: "form" };
const CONTENT: Readonly<Record<Tab, () => JSX.Element>> = {
  ask: QueryTab,
  models: ModelsTab,
  scenes: ScenesTab,
};

export function WalkingPage({ tab }: { readonly tab: string | undefined }): JSX.Element {
  const { t } = useTexts();
  const [, navigate] = useLocation();
  useTitle(t("walking.title"));
  const shown = TABS.find((one) => one === tab) ?? "ask";
  const Content = CONTENT[shown];
  return (
    <>
      <div className={classes.head}>
        <Title order={1}>{t("walking.title")}</Title>
        <Text c="dimmed">{t("walking.lead")}</Text>
      </div>
      <Tabs
        value={shown}
        onChange={(value) => navigate(`/walking/${value ?? "ask"}`)}
        keepMounted={false}
      >
        <Tabs.List>
          {TABS.map((name) => (
            <Tabs.Tab key={name} value={name} leftSection={<Icon name={ICONS[name]} size={17} />}>
              {t(`walking.tab.${name}`)}
            </Tabs.Tab>
          ))}
        </Tabs.List>
        <Tabs.Panel value={shown} className={classes.panel ?? ""}>
          <Content />
        </Tabs.Panel>
      </Tabs>
    </>
  );
}
