/** What should be there before the session starts. It informs and does not stand in the way. */
import type { Device, SessionView } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { SlotMark } from "../ui/SlotMark";
import classes from "./CurrentStep.module.css";

const DEVICES: readonly Device[] = ["tablet", "headset"];

export function Readiness({ session }: { readonly session: SessionView }): JSX.Element {
  const { t } = useTexts();
  return (
    <ul className={classes.checklist}>
      {DEVICES.map((kind) => {
        const devices = session.devices.filter((device) => device.kind === kind);
        const connected = devices.some((device) => device.connected);
        const state = connected ? "connected" : devices.length > 0 ? "lost" : "unpaired";
        return (
          <li key={kind}>
            <SlotMark state={connected ? "completed" : "free"} />
            <Icon name={kind} />
            {t(`device.${kind}`)}
            <span className={classes.readyState}>{t(`device.${state}`)}</span>
          </li>
        );
      })}
    </ul>
  );
}
