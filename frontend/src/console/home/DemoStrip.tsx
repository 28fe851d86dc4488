/** On the pages of the demo lab's study and sessions: that its people are simulated. */
import { Icon } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useLocation } from "wouter";
import { useTexts } from "../i18n";
import { sessionQuery } from "../queries";
import { DemoProgress, DemoStatus, LoadRest, RemoveDemo } from "./DemoControls";
import { useFollowedDemo } from "./demo";
import { demoPlace, isThere } from "./demoState";
import classes from "./Home.module.css";

export function DemoStrip(): JSX.Element | null {
  const { t } = useTexts();
  const [address] = useLocation();
  const id = /^\/sessions\/([^/?]+)/.exec(address)?.[1];
  // The session's page has requested it anyway.
  const session = useQuery({ ...sessionQuery(id ?? ""), enabled: false }).data;
  const demo = useFollowedDemo();
  const place = demoPlace(address, session ?? null);
  if (place === null || demo?.state === "absent") return null;
  return (
    <section className={classes.strip} data-strip aria-label={t("demo.label")}>
      <Icon name="body" size={17} />
      <strong>{t("simulated.watermark")}</strong>
      {place === "session" || !isThere(demo) ? (
        <span>{t(place === "session" ? "demo.session" : "demo.loaded")}</span>
      ) : (
        <>
          <DemoStatus demo={demo} all={t("demo.loaded")} />
          <DemoProgress demo={demo} />
          <span className={classes.stripButtons}>
            <LoadRest demo={demo} />
            {place === "overview" && <RemoveDemo />}
          </span>
        </>
      )}
    </section>
  );
}
