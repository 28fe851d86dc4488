/** A pairing code, in type that can be read across the room, and the same as a QR code. */
import { Anchor, Button, Loader, Modal } from "@mantine/core";
import { sessions } from "@shared/api/endpoints";
import type { Device, Pairing, SessionView } from "@shared/api/types";
import { clockFace } from "@shared/format";
import { Notice } from "@shared/ui/Notice";
import { seconds } from "@shared/units";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useEffect, useRef, useState } from "react";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { lanCommand } from "../../pages/network/lanCommand";
import { networkQuery } from "../../queries";
import { useShown } from "../../ui/page";
import classes from "../Panels.module.css";

interface PairingDialogProps {
  readonly session: SessionView;
  readonly device: Device | null;
  readonly onClose: () => void;
}

export function PairingDialog({ session, device, onClose }: PairingDialogProps): JSX.Element {
  const { t } = useTexts();
  const named = useShown(device);
  return (
    <Modal
      opened={device !== null}
      onClose={onClose}
      size="md"
      title={named && t(`device.pair.${named}`)}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      {device !== null && <Code session={session} device={device} onClose={onClose} />}
    </Modal>
  );
}

const PAGES: Readonly<Record<Device, string>> = { tablet: "/tablet", headset: "/vr" };

interface CodeProps extends PairingDialogProps {
  readonly device: Device;
}

function Code({ session, device, onClose }: CodeProps): JSX.Element {
  const query = useQuery({
    queryKey: ["pairing", session.id, device],
    queryFn: () => sessions.pair(session.id, device),
    staleTime: Number.POSITIVE_INFINITY,
    gcTime: 0,
    refetchOnMount: "always",
    refetchOnWindowFocus: false,
  });
  useCloseWhenPaired(session, device, onClose);
  if (query.isError) return <Failure error={query.error} onRetry={() => void query.refetch()} />;
  if (query.data === undefined || query.isFetching) {
    return (
      <div className={classes.pair}>
        <Loader />
      </div>
    );
  }
  return <CodeShown pairing={query.data} device={device} onRenew={() => void query.refetch()} />;
}

/** Close the dialog when the code has been used: a device is there that was not when it opened. */
function useCloseWhenPaired(session: SessionView, device: Device, onClose: () => void): void {
  const earlierDevices = useRef(new Set(session.devices.map(({ id }) => id)));
  const arrived = session.devices.some(
    ({ id, kind }) => kind === device && !earlierDevices.current.has(id),
  );
  useEffect(() => {
    if (arrived) onClose();
  }, [arrived, onClose]);
}

interface CodeShownProps {
  readonly pairing: Pairing;
  readonly device: Device;
  readonly onRenew: () => void;
}

function CodeShown({ pairing, device, onRenew }: CodeShownProps): JSX.Element {
  const { t } = useTexts();
  const left = useSecondsUntil(pairing.expires_at);
  if (left <= 0) {
    return (
      <Notice
        tone="warn"
        title={t("pairing.expired")}
        actions={
          <Button size="xs" onClick={onRenew}>
            {t("pairing.renew")}
          </Button>
        }
      />
    );
  }
  return (
    <div className={classes.pair}>
      {pairing.url !== null && <span>{t(`pairing.how.${device}`)}</span>}
      <output className={classes.code}>{pairing.code}</output>
      {pairing.qr_svg !== null && (
        <img
          className={classes.qr}
          alt={t("pairing.qr")}
          src={`data:image/svg+xml;charset=utf-8,${encodeURIComponent(pairing.qr_svg)}`}
        />
      )}
      {pairing.url === null ? (
        <LocalhostOnly pairing={pairing} device={device} />
      ) : (
        <span className={classes.url}>{pairing.url}</span>
      )}
      {device === "headset" && pairing.server_url !== null && (
        <span className={classes.program}>
          {t("pairing.how.program", { url: pairing.server_url })}
        </span>
      )}
      <FirstTime pairing={pairing} />
      <span className="numbers">{t("pairing.left", { time: clockFace(seconds(left)) })}</span>
    </div>
  );
}

/** No other device can reach the server: how to change that, and what works without. */
function LocalhostOnly({
  pairing,
  device,
}: {
  readonly pairing: Pairing;
  readonly device: Device;
}): JSX.Element {
  const { t } = useTexts();
  const network = useQuery(networkQuery).data;
  return (
    <Notice tone="warn" title={t("pairing.onlyHere")}>
      <p className={classes.localhostOnly}>{t("pairing.onlyHere.body")}</p>
      <code className={classes.localhostOnly}>{lanCommand(window.location.port)}</code>
      {device === "headset" && network !== undefined && (
        <>
          <p className={classes.localhostOnly}>{t("pairing.onlyHere.cable")}</p>
          <code className={classes.localhostOnly}>{network.cable.command}</code>
          <code className={classes.localhostOnly}>
            {`${network.cable.url}?code=${pairing.code}`}
          </code>
        </>
      )}
      <p className={classes.localhostOnly}>
        <Anchor href={`${PAGES[device]}?code=${pairing.code}`} target="_blank">
          {t(`pairing.onlyHere.open.${device}`)}
        </Anchor>
      </p>
    </Notice>
  );
}

/** Collapsed, because it is needed only once for each device. */
function FirstTime({ pairing }: { readonly pairing: Pairing }): JSX.Element | null {
  const { t } = useTexts();
  if (pairing.help_url === null || pairing.help_qr_svg === null) return null;
  return (
    <details className={classes.first}>
      <summary>{t("pairing.first")}</summary>
      <img
        className={classes.qr}
        alt={t("pairing.first.qr")}
        src={`data:image/svg+xml;charset=utf-8,${encodeURIComponent(pairing.help_qr_svg)}`}
      />
      <span className={classes.url}>{pairing.help_url}</span>
    </details>
  );
}

function useSecondsUntil(iso: string): number {
  const until = () => Math.max(0, Math.ceil((Date.parse(iso) - Date.now()) / 1000));
  const [left, setLeft] = useState(until);
  // biome-ignore lint/correctness/useExhaustiveDependencies: `until` only depends on `iso`
  useEffect(() => {
    setLeft(until());
    const timer = setInterval(() => setLeft(until()), 1000);
    return () => clearInterval(timer);
  }, [iso]);
  return left;
}
