/** The frame of the pages before anybody is signed in. */
import { Title } from "@mantine/core";
import { Mark } from "@shared/ui/Mark";
import type { JSX, ReactNode } from "react";
import { useTexts } from "../i18n";
import { Echo } from "./Echo";
import classes from "./Login.module.css";

interface FrontProps {
  readonly title: string;
  readonly children: ReactNode;
}

export function Front({ title, children }: FrontProps): JSX.Element {
  const { t } = useTexts();
  return (
    <main className={classes.page}>
      <div className={classes.figure}>
        <Echo />
      </div>
      <div className={classes.form}>
        <div className={classes.brand}>
          <Mark size={32} />
          {t("app.name")}
        </div>
        <Title order={1}>{title}</Title>
        {children}
      </div>
    </main>
  );
}
