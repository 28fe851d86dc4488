import { Paper, Title } from "@mantine/core";
import type { Network } from "@shared/api/types";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { Copyable } from "./Copyable";
import classes from "./Network.module.css";
import { QrCode } from "./QrCode";

/** The page, over plain http, on which a device gets the lab's certificate. */
export function FirstTime({ help }: { readonly help: NonNullable<Network["help"]> }): JSX.Element {
  const { t } = useTexts();
  return (
    <Paper>
      <Title order={2} mb="md">
        {t("network.first")}
      </Title>
      <div className={classes.beside}>
        <div>
          <p className={classes.text}>{t("network.first.body")}</p>
          <Copyable text={help.url} />
        </div>
        <QrCode svg={help.qr_svg} alt={t("network.first.qr")} />
      </div>
    </Paper>
  );
}
