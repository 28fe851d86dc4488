/** A short message on the page: what is the matter, and what to do about it. */
import type { JSX, ReactNode } from "react";
import { Icon, type IconName } from "./Icon";
import classes from "./Notice.module.css";

export type Tone = "info" | "warn" | "bad" | "sim";

const ICONS: Readonly<Record<Tone, IconName>> = {
  info: "info",
  warn: "alert",
  bad: "alert",
  sim: "body",
};

interface NoticeProps {
  readonly tone: Tone;
  readonly title?: string;
  readonly children?: ReactNode;
  readonly remedy?: ReactNode;
  readonly actions?: ReactNode;
  readonly icon?: IconName;
}

export function Notice({ tone, title, children, remedy, actions, icon }: NoticeProps): JSX.Element {
  return (
    <div
      className={`${classes.notice} ${classes[tone]}`}
      role={tone === "bad" ? "alert" : "status"}
    >
      <Icon name={icon ?? ICONS[tone]} />
      <div>
        {title !== undefined && <div className={classes.title}>{title}</div>}
        {children !== undefined && <div className={classes.body}>{children}</div>}
        {remedy !== undefined && <div className={classes.remedy}>{remedy}</div>}
        {actions !== undefined && <div className={classes.actions}>{actions}</div>}
      </div>
    </div>
  );
}
