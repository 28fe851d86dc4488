/** What the file of a body says of its author and terms. */
import { Title } from "@mantine/core";
import type { BodyView } from "@shared/api/bodies";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./Bodies.module.css";
import { isPermission } from "./texts";

export function Licence({ body }: { readonly body: BodyView }): JSX.Element {
  const { t } = useTexts();
  const { licence } = body;
  return (
    <section className={classes.panel} aria-labelledby="body-licence">
      <Title order={2} size="h3" id="body-licence">
        {t("bodies.licence")}
      </Title>
      {licence === null ? (
        <p className={classes.soft}>{t("bodies.licence.unread")}</p>
      ) : (
        <dl className={classes.terms}>
          <Entry name={t("bodies.licence.title")}>{licence.title}</Entry>
          <Entry name={t("bodies.licence.authors")}>{licence.authors.join(", ") || null}</Entry>
          <Entry name={t("bodies.licence.name")}>{licence.name}</Entry>
          <Entry name={t("bodies.licence.url")}>{licence.url}</Entry>
          {Object.entries(licence.permissions).map(([use, permission]) => (
            <Entry
              key={use}
              name={isPermission(use) ? t(`bodies.use.${use}`) : use}
              status={permission}
            >
              {t(`bodies.permission.${permission}`)}
            </Entry>
          ))}
        </dl>
      )}
    </section>
  );
}

interface EntryProps {
  readonly name: string;
  readonly children: string | null;
  readonly status?: string;
}

function Entry({ name, children, status }: EntryProps): JSX.Element {
  const { t } = useTexts();
  return (
    <div data-status={status}>
      <dt>{name}</dt>
      <dd>{children ?? <span className={classes.soft}>{t("bodies.licence.nothing")}</span>}</dd>
    </div>
  );
}
