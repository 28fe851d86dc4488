import { Paper, Title } from "@mantine/core";
import type { Network } from "@shared/api/types";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { Copyable } from "./Copyable";
import classes from "./Network.module.css";

/** The way that needs no network: the headset's own localhost leads here. */
export function Cable({ cable }: { readonly cable: Network["cable"] }): JSX.Element {
  const { t } = useTexts();
  return (
    <Paper>
      <Title order={2} mb="md">
        {t("network.cable")}
      </Title>
      <p className={classes.text}>{t("network.cable.body")}</p>
      <Copyable text={cable.command} />
      <p className={classes.text}>{t("network.cable.then")}</p>
      <Copyable text={cable.url} />
    </Paper>
  );
}
