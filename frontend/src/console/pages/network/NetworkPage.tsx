/** How tablets and headsets reach the server: addresses, certificate, help page, USB cable. */
import { Paper, Text, Title } from "@mantine/core";
import type { Network } from "@shared/api/types";
import { day } from "@shared/format";
import { Notice, type Tone } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { networkQuery } from "../../queries";
import { Loaded } from "../../ui/Loaded";
import { useTitle } from "../../ui/page";
import { Copyable } from "./Copyable";
import { lanCommand } from "./lanCommand";
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
        {t(`network.mode.${network.mode}.body`, { command: lanCommand(window.location.port) })}
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

/** Every address, the best one with the QR codes of the tablet's and the headset's page. */
function Addresses({ network }: { readonly network: Network }): JSX.Element {
  const { t } = useTexts();
  const [best] = network.addresses;
  return (
    <Paper>
      <Title order={2} mb="md">
        {t("network.addresses")}
      </Title>
      <div className={classes.sideBySide}>
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
          <div className={classes.codes}>
            <QrCode
              svg={best.tablet_qr_svg}
              alt={t("network.addresses.tablet", { url: best.tablet_url })}
              caption={t("network.addresses.scan")}
            />
            <QrCode
              svg={best.headset_qr_svg}
              alt={t("network.addresses.headset", { url: best.headset_url })}
              caption={t("network.addresses.scan.headset")}
            />
          </div>
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

/**
 * The connection by USB cable, without a network: the headset's own localhost leads to the server.
 */
function Cable({ cable }: { readonly cable: Network["cable"] }): JSX.Element {
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

type CertificateView = NonNullable<Network["certificate"]>;

/** The fingerprint to compare with a device's screen before trusting it, and its expiry date. */
function Certificate({ certificate }: { readonly certificate: CertificateView }): JSX.Element {
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

function Expiry({ certificate }: { readonly certificate: CertificateView }): JSX.Element {
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

/** The page, over plain http, on which a device gets the lab's certificate. */
function FirstTime({ help }: { readonly help: NonNullable<Network["help"]> }): JSX.Element {
  const { t } = useTexts();
  return (
    <Paper>
      <Title order={2} mb="md">
        {t("network.first")}
      </Title>
      <div className={classes.sideBySide}>
        <div>
          <p className={classes.text}>{t("network.first.body")}</p>
          <Copyable text={help.url} />
        </div>
        <QrCode svg={help.qr_svg} alt={t("network.first.qr")} />
      </div>
    </Paper>
  );
}

interface QrCodeProps {
  readonly svg: string;
  readonly alt: string;
  readonly caption?: string;
}

/** A QR code drawn by the server, on white in either colour scheme: cameras need the contrast. */
function QrCode({ svg, alt, caption }: QrCodeProps): JSX.Element {
  return (
    <figure className={classes.figure}>
      <img
        className={classes.qr}
        alt={alt}
        src={`data:image/svg+xml;charset=utf-8,${encodeURIComponent(svg)}`}
      />
      {caption !== undefined && <figcaption>{caption}</figcaption>}
    </figure>
  );
}

const PAIRS_IN_A_GROUP = 4;

/** Split a fingerprint into groups of four pairs: as much as people compare at a glance. */
export function inGroups(fingerprint: string): readonly { at: number; text: string }[] {
  const pairs = fingerprint.split(":");
  const groups = Array.from({ length: Math.ceil(pairs.length / PAIRS_IN_A_GROUP) }, (_, at) => at);
  return groups.map((at) => ({
    at,
    text: pairs.slice(at * PAIRS_IN_A_GROUP, (at + 1) * PAIRS_IN_A_GROUP).join(":"),
  }));
}
