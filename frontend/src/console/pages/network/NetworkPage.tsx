/** How tablets and headsets reach the server: addresses, certificate, help page, USB cable. */
import { Text, Title } from "@mantine/core";
import type { Network } from "@shared/api/types";
import { Notice, type Tone } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { networkQuery } from "../../queries";
import { Loaded } from "../../ui/Loaded";
import { useTitle } from "../../ui/useTitle";
import { Addresses } from "./Addresses";
import { Cable } from "./Cable";
import { Certificate } from "./Certificate";
import { FirstTime } from "./FirstTime";
import classes from "./Network.module.css";

const TONES: Readonly<Record<Network["mode"], Tone>> = {
  loopback: "info",
  lan: "info",
  without_tls: "bad",
};

export function NetworkPage(): JSX.Element {
  const { t } = useTexts();
  useTitle(t("network.title"));
  return (
    <>
      <Title order={1}>{t("network.title")}</Title>
      <Text c="dimmed" mb="lg">
        {t("network.lead")}
      </Text>
      <Loaded query={useQuery(networkQuery)}>{(network) => <Parts network={network} />}</Loaded>
    </>
  );
}

function Parts({ network }: { readonly network: Network }): JSX.Element {
  const { t } = useTexts();
  return (
    <>
      <Notice
        tone={TONES[network.mode]}
        icon={network.mode === "lan" ? "lock" : network.mode === "loopback" ? "info" : "alert"}
        title={t(`network.mode.${network.mode}`)}
      >
        {t(`network.mode.${network.mode}.body`)}
      </Notice>
      <div className={classes.grid}>
        <Addresses network={network} />
        {network.help !== null && <FirstTime help={network.help} />}
        {network.certificate !== null && <Certificate certificate={network.certificate} />}
        <Cable cable={network.cable} />
      </div>
    </>
  );
}
