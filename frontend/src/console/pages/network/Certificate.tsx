import { Paper, Title } from "@mantine/core";
import type { Network } from "@shared/api/types";
import { day } from "@shared/format";
import { Notice } from "@shared/ui/Notice";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { inGroups } from "./fingerprint";
import classes from "./Network.module.css";

type Shown = NonNullable<Network["certificate"]>;

/** What a person compares with a device's screen before trusting it, and how long it lasts. */
export function Certificate({ certificate }: { readonly certificate: Shown }): JSX.Element {
  const { t } = useTexts();
  const own = certificate.source === "files";
  return (
    <Paper>
      <Title order={2} mb="md">
        {t("network.certificate")}
      </Title>
      <h3 className={classes.label}>{t("network.fingerprint")}</h3>
      <p className={classes.fingerprint}>
        {inGroups(certificate.fingerprint).map((group) => (
          <span key={group.at}>{group.text}</span>
        ))}
      </p>
      <p className={classes.soft}>
        {t(own ? "network.fingerprint.own" : "network.fingerprint.compare")}
      </p>
      <h3 className={classes.label}>{t("network.expires")}</h3>
      <Expiry certificate={certificate} />
      {certificate.uncovered.length > 0 && (
        <Notice tone="warn" title={t("network.uncovered")}>
          {t(own ? "network.uncovered.own" : "network.uncovered.body", {
            addresses: certificate.uncovered.join(", "),
          })}
        </Notice>
      )}
    </Paper>
  );
}

function Expiry({ certificate }: { readonly certificate: Shown }): JSX.Element {
  const { t, language } = useTexts();
  const date = day(certificate.expires_at, language);
  return (
    <p className={classes.text}>
      {certificate.authority_expires_at === null
        ? t("network.expires.own", { date })
        : t("network.expires.authority", {
            date,
            authority: day(certificate.authority_expires_at, language),
          })}
    </p>
  );
}
