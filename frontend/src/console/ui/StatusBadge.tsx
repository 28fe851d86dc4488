/** The state of a session in a word and a sign. */
import type { SessionStatus } from "@shared/api/types";
import { Icon, type IconName } from "@shared/ui/Icon";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./ui.module.css";

const ICONS: Readonly<Record<SessionStatus, IconName>> = {
  planned: "clock",
  active: "play",
  completed: "check",
  aborted: "stop",
  withdrawn: "close",
};

export function StatusBadge({ status }: { readonly status: SessionStatus }): JSX.Element {
  const { t } = useTexts();
  return (
    <span className={`${classes.badge} ${classes[status]}`}>
      <Icon name={ICONS[status]} size={14} />
      {t(`status.${status}`)}
    </span>
  );
}
