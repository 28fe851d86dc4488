/** A page of a session that is meant for paper: what leads back, a button to print, and the sheet. */
import { Button } from "@mantine/core";
import { Icon } from "@shared/ui/Icon";
import type { JSX, ReactNode } from "react";
import { Link } from "wouter";
import classes from "./PaperPage.module.css";

interface PaperPageProps {
  readonly sessionId: string;
  readonly back: string;
  readonly print: string;
  /** The sheet is an `article`: on paper it has no border and no margin of its own. */
  readonly children: ReactNode;
}

export function PaperPage({ sessionId, back, print, children }: PaperPageProps): JSX.Element {
  return (
    <div className={classes.page}>
      <div className={classes.tools}>
        <Button
          component={Link}
          href={`/sessions/${sessionId}`}
          variant="subtle"
          color="gray"
          leftSection={<Icon name="back" size={16} />}
        >
          {back}
        </Button>
        <Button leftSection={<Icon name="document" size={18} />} onClick={() => window.print()}>
          {print}
        </Button>
      </div>
      {children}
    </div>
  );
}
