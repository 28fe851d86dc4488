import { Paper, Title } from "@mantine/core";
import type { Network } from "@shared/api/types";
import { Notice } from "@shared/ui/Notice";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { Copyable } from "./Copyable";
import classes from "./Network.module.css";
import { QrCode } from "./QrCode";

/** Every address, the best one with the QR code of the tablet's page. */
export function Addresses({ network }: { readonly network: Network }): JSX.Element {
  const { t } = useTexts();
  const [best] = network.addresses;
  return (
    <Paper>
      <Title order={2} mb="md">
        {t("network.addresses")}
      </Title>
      <div className={classes.beside}>
        <dl className={classes.list}>
          {network.addresses.map(({ url }) => (
            <div key={url}>
              <dt>{url === best?.url && t("network.addresses.devices")}</dt>
              <dd>
                <Copyable text={url} />
              </dd>
            </div>
          ))}
          <div>
            <dt>{t("network.local")}</dt>
            <dd>
              <Copyable text={network.local_url} />
            </dd>
          </div>
        </dl>
        {best !== undefined && (
          <QrCode
            svg={best.tablet_qr_svg}
            alt={t("network.addresses.tablet", { url: best.tablet_url })}
            caption={t("network.addresses.scan")}
          />
        )}
      </div>
      {best === undefined && network.mode !== "loopback" && (
        <Notice tone="warn" title={t("network.none")}>
          {t("network.none.body")}
        </Notice>
      )}
    </Paper>
  );
}
