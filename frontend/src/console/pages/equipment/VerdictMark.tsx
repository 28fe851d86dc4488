/** A verdict as a shape and a word, not by colour alone. */
import type { SelfTestView } from "@shared/selfTest/verdict";
import { Icon, type IconName } from "@shared/ui/Icon";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import classes from "./SelfTests.module.css";

const ICONS: Readonly<Record<SelfTestView["status"], IconName>> = {
  ok: "check",
  warn: "info",
  fail: "alert",
};

export function VerdictMark({ status }: Pick<SelfTestView, "status">): JSX.Element {
  const { t } = useTexts();
  return (
    <span className={`${classes.mark} ${classes[status]}`}>
      <Icon name={ICONS[status]} size={16} />
      {t(`selftest.status.${status}`)}
    </span>
  );
}
