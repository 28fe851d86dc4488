/** The explanation of an empty list: what it is for and how to fill it. */
import { Title } from "@mantine/core";
import { Icon, type IconName } from "@shared/ui/Icon";
import type { JSX, ReactNode } from "react";
import classes from "./ui.module.css";

interface EmptyStateProps {
  readonly icon: IconName;
  readonly title: string;
  readonly children: ReactNode;
  readonly action?: ReactNode;
}

export function EmptyState({ icon, title, children, action }: EmptyStateProps): JSX.Element {
  return (
    <div className={classes.empty}>
      <Icon name={icon} size={32} />
      <Title order={2}>{title}</Title>
      <div className={classes.emptyText}>{children}</div>
      {action}
    </div>
  );
}
