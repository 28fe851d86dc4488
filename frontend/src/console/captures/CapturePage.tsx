/** One capture: its movement, its joint map, and its verification on avatars. */
import { Tabs } from "@mantine/core";
import type { Capture } from "@shared/api/captures";
import { Icon, type IconName } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link, useLocation } from "wouter";
import { LeaveGuard } from "../editor/LeaveGuard";
import { useTexts } from "../i18n";
import { Loaded } from "../ui/Loaded";
import { useTitle } from "../ui/page";
import classes from "./Capture.module.css";
import { CaptureHead } from "./CaptureHead";
import { JointMapTab } from "./JointMapTab";
import { MovementTab } from "./MovementTab";
import type { TabProps } from "./NoAvatar";
import { captureQuery } from "./queries";
import { useJointMap } from "./useJointMap";
import { VerificationTab } from "./VerificationTab";

const TABS = ["movement", "joints", "verification"] as const;
type Tab = (typeof TABS)[number];

const ICONS: Readonly<Record<Tab, IconName>> = {
  movement: "walk",
  joints: "body",
  verification: "chart",
};

const CONTENT: Readonly<Record<Tab, (props: TabProps) => JSX.Element>> = {
  movement: MovementTab,
  joints: JointMapTab,
  verification: VerificationTab,
};

interface CapturePageProps {
  readonly id: string;
  readonly tab: string | undefined;
}

export function CapturePage({ id, tab }: CapturePageProps): JSX.Element {
  const { t } = useTexts();
  return (
    <>
      <Link href="/captures" className={classes.crumbs ?? ""}>
        <Icon name="back" size={16} />
        {t("captures.title")}
      </Link>
      <Loaded query={useQuery(captureQuery(id))}>
        {(capture) => (
          <CaptureTabs capture={capture} tab={TABS.find((name) => name === tab) ?? "movement"} />
        )}
      </Loaded>
    </>
  );
}

function CaptureTabs({
  capture,
  tab,
}: {
  readonly capture: Capture;
  readonly tab: Tab;
}): JSX.Element {
  const { t } = useTexts();
  const [, navigate] = useLocation();
  useTitle(capture.title);
  // Kept here, so that unsaved changes survive a visit to another tab.
  const map = useJointMap(capture);
  const Content = CONTENT[tab];
  return (
    <>
      <CaptureHead capture={capture} />
      <LeaveGuard unsaved={map.unsaved} />
      <Tabs
        value={tab}
        onChange={(value) => navigate(`/captures/${capture.id}/${value ?? "movement"}`)}
        keepMounted={false}
      >
        <Tabs.List>
          {TABS.map((name) => (
            <Tabs.Tab key={name} value={name} leftSection={<Icon name={ICONS[name]} size={17} />}>
              {t(`capture.tab.${name}`)}
              {name === "joints" && map.unsaved && (
                <span className={classes.unsaved} title={t("map.unsaved")}>
                  <span className="visually-hidden">{t("map.unsaved")}</span>
                </span>
              )}
            </Tabs.Tab>
          ))}
        </Tabs.List>
        <Tabs.Panel value={tab} className={classes.panel ?? ""}>
          <Content capture={capture} map={map} />
        </Tabs.Panel>
      </Tabs>
    </>
  );
}
