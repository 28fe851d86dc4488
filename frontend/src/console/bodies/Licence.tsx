/** What the file of a body says of its author and terms. */
import { Title } from "@mantine/core";
import type { BodyView } from "@shared/api/bodies";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./Bodies.module.css";
import { knownLicence, licenceName } from "./names";

const USES = [
  ...(["commercial", "modification", "redistribution"] as const),
  ...(["violent", "sexual", "political", "antisocial"] as const),
];

export function Licence({ body }: { readonly body: BodyView }): JSX.Element {
  const { t } = useTexts();
  const { licence } = body;
  const known = knownLicence(licence?.name ?? "");
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
          <Entry name={t("bodies.licence.authors")}>{licence.authors.join(", ")}</Entry>
          <Entry name={t("bodies.licence.copyright")}>{licence.copyright}</Entry>
          <Entry name={t("bodies.licence.name")}>
            {[
              licenceName(licence.name, t),
              known === null ? "" : t(`bodies.licence.means.${known}`),
            ]
              .filter((words) => words !== "")
              .join(": ")}
          </Entry>
          <Entry name={t("bodies.licence.url")}>
            {[licence.url, licence.other_url].filter((url) => url !== "").join(" ")}
          </Entry>
          <Entry name={t("bodies.licence.wearers")}>{t(`bodies.wearers.${licence.wearers}`)}</Entry>
          {USES.map((use) => (
            <Entry key={use} name={t(`bodies.use.${use}`)} status={licence.permissions[use]}>
              {t(`bodies.permission.${licence.permissions[use] ?? "unknown"}`)}
            </Entry>
          ))}
          <Entry name={t("bodies.licence.credit")}>
            {t(`bodies.credit.${licence.credit_needed ?? "unknown"}`)}
          </Entry>
        </dl>
      )}
    </section>
  );
}

interface EntryProps {
  readonly name: string;
  readonly children: string;
  readonly status?: string | undefined;
}

function Entry({ name, children, status }: EntryProps): JSX.Element {
  const { t } = useTexts();
  return (
    <div data-status={status}>
      <dt>{name}</dt>
      <dd>
        {children === "" ? (
          <span className={classes.soft}>{t("bodies.licence.nothing")}</span>
        ) : (
          children
        )}
      </dd>
    </div>
  );
}
