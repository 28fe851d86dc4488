/** That the door of a source is closed, which no sender can mend, and where it is opened. */
import type { Door } from "@shared/api/trackers";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link } from "wouter";
import { useTexts } from "../../i18n";
import { trackersQuery } from "../../queries";
import classes from "./LabTrackersPanel.module.css";

/** Whether a source that sends nothing cannot: its door is closed. Asked only while it is silent. */
export function useIsDoorClosed(door: Door["door"] | null, isSilent: boolean): boolean {
  const isAsked = door !== null && isSilent;
  const { data } = useQuery({ ...trackersQuery, enabled: isAsked });
  return isAsked && data?.doors.some((one) => one.door === door && !one.is_open) === true;
}

export function ClosedDoor({ door }: { readonly door: Door["door"] }): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.closed}>
      <Notice
        tone="warn"
        title={t("lab.closed")}
        actions={
          <Link href="/trackers" className={classes.link ?? ""}>
            {t("lab.page")}
          </Link>
        }
      >
        {t("lab.closed.body", { door: t(`trackers.door.${door}`) })}
      </Notice>
    </div>
  );
}
