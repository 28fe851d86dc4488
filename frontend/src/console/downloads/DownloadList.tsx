/** The person's files, newest first; of one study where a page is about it. */
import type { Export } from "@shared/api/housekeeping";
import { Notice } from "@shared/ui/Notice";
import type { UseQueryResult } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { DownloadCard } from "./DownloadCard";
import classes from "./Downloads.module.css";
import { useDesk } from "./desk";
import { isOpen } from "./useExports";

interface DownloadListProps {
  readonly query: UseQueryResult<readonly Export[]>;
  readonly studyKey?: string;
}

export function DownloadList({ query, studyKey }: DownloadListProps): JSX.Element | null {
  const { t } = useTexts();
  const { gone } = useDesk();
  const shown = (query.data ?? []).filter(
    (one) => studyKey === undefined || one.study_key === studyKey,
  );
  const lost = query.isError && shown.some(isOpen);
  if (shown.length === 0 && !gone) return null;
  return (
    <div>
      {(lost || gone) && (
        <div className={classes.notices}>
          {lost && (
            <Notice tone="warn" title={t("downloads.lost")}>
              {t("downloads.lost.body")}
            </Notice>
          )}
          {gone && (
            <Notice tone="warn" title={t("downloads.gone")}>
              {t("downloads.gone.body")}
            </Notice>
          )}
        </div>
      )}
      <ul className={classes.list}>
        {shown.map((one) => (
          <DownloadCard key={one.id} one={one} />
        ))}
      </ul>
    </div>
  );
}
