/** What the file of a body says of its author and terms. */
import { Anchor, Title } from "@mantine/core";
import type { BodyView } from "@shared/api/bodies";
import type { JSX, ReactNode } from "react";
import { useTexts } from "../i18n";
import classes from "./Bodies.module.css";
import { knownLicence, licenceName, licenceWritten } from "./names";

const USES = [
  ...(["commercial", "modification", "redistribution"] as const),
  ...(["violent", "sexual", "political", "antisocial"] as const),
];

export function Licence({ body }: { readonly body: BodyView }): JSX.Element {
  const { t } = useTexts();
  const { licence } = body;
  const written = licence === null ? "" : licenceWritten(licence);
  const known = knownLicence(written);
  const unsaid =
    licence === null
      ? []
      : [
          ...(licence.title === "" ? [t("bodies.licence.title")] : []),
          ...(licence.authors.length === 0 ? [t("bodies.licence.authors")] : []),
          ...(licence.copyright === "" ? [t("bodies.licence.copyright")] : []),
          ...(written === "" ? [t("bodies.licence.name")] : []),
          ...(licence.url + licence.other_url === "" ? [t("bodies.licence.url")] : []),
          ...(licence.wearers === "unknown" ? [t("bodies.licence.wearers")] : []),
          ...USES.filter((use) => isUnsaid(licence.permissions[use])).map((use) =>
            t(`bodies.use.${use}`),
          ),
          ...(licence.credit_needed === null ? [t("bodies.licence.credit")] : []),
        ];
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
            {[licenceName(written, t), known === null ? "" : t(`bodies.licence.means.${known}`)]
              .filter((words) => words !== "")
              .join(": ")}
          </Entry>
          <Entry name={t("bodies.licence.url")}>
            {[licence.url, licence.other_url].filter((url) => url !== "").map(addressOf)}
          </Entry>
          <Entry name={t("bodies.licence.wearers")}>
            {licence.wearers === "unknown" ? "" : t(`bodies.wearers.${licence.wearers}`)}
          </Entry>
          {USES.map((use) => (
            <Entry key={use} name={t(`bodies.use.${use}`)} status={licence.permissions[use]}>
              {isUnsaid(licence.permissions[use])
                ? ""
                : t(`bodies.permission.${licence.permissions[use] ?? "unknown"}`)}
            </Entry>
          ))}
          <Entry name={t("bodies.licence.credit")}>
            {licence.credit_needed === null ? "" : t(`bodies.credit.${licence.credit_needed}`)}
          </Entry>
        </dl>
      )}
      {unsaid.length > 0 && (
        <p className={classes.soft}>{t("bodies.licence.unsaid", { names: unsaid.join(", ") })}</p>
      )}
    </section>
  );
}

interface EntryProps {
  readonly name: string;
  /** What is not stated is told below, all in one sentence. */
  readonly children: ReactNode;
  readonly status?: string | undefined;
}

function Entry({ name, children, status }: EntryProps): JSX.Element | null {
  if (children === "" || (Array.isArray(children) && children.length === 0)) return null;
  return (
    <div data-status={status}>
      <dt>{name}</dt>
      <dd>{children}</dd>
    </div>
  );
}

const isUnsaid = (permission: string | undefined): boolean =>
  permission === undefined || permission === "unknown";

/** A web address as a link; what else stands there is shown as it is. */
function addressOf(url: string): JSX.Element {
  return /^https?:\/\//i.test(url) ? (
    <Anchor
      key={url}
      href={url}
      target="_blank"
      rel="noreferrer"
      inherit
      className={classes.address ?? ""}
    >
      {url.replace(/^https?:\/\//i, "")}
    </Anchor>
  ) : (
    <span key={url} className={classes.address}>
      {url}
    </span>
  );
}
