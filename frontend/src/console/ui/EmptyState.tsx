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
  /** Where it is all there is of a page, its title is the page's. */
  readonly isPage?: boolean;
}

export function EmptyState(props: EmptyStateProps): JSX.Element {
  const { icon, title, children, action, isPage = false } = props;
  return (
    <div className={classes.empty}>
      <Icon name={icon} size={32} />
      <Title order={isPage ? 1 : 2} size="h2">
        {title}
      </Title>
      <div className={classes.emptyText}>{children}</div>
      {action}
    </div>
  );
}
