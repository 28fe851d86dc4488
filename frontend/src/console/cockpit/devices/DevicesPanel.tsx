/** Tablet and headset: whether they are connected, and how to pair them. */

import { ActionIcon, Button } from "@mantine/core";
import { sessions } from "@shared/api/endpoints";
import type { Device, PairedDevice, SessionView } from "@shared/api/types";
import { ago, duration } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { seconds } from "@shared/units";
import { useMutation } from "@tanstack/react-query";
import { type JSX, useEffect, useState } from "react";
import { useTexts } from "../../i18n";
import { opened, useOpenOnScreen } from "../../tour/onScreen";
import { Key } from "../../ui/Key";
import cockpit from "../Cockpit.module.css";
import { ConnectionMark } from "../ConnectionMark";
import classes from "../Panels.module.css";
import { isBusy } from "../session/keys";
import { PairingDialog } from "./PairingDialog";
import { type Doing, doing } from "./words";

const KINDS: readonly Device[] = ["tablet", "headset"];
/** Keys for pairing, whose buttons are far down the page for keyboard users. */
const PAIR_KEYS: Readonly<Record<Device, string>> = { tablet: "T", headset: "H" };

export function DevicesPanel({ session }: { readonly session: SessionView }): JSX.Element {
  const { t } = useTexts();
  const [pairing, setPairing] = useState<Device | null>(null);
  usePairKeys(setPairing);
  return (
    <section data-tour="devices">
      <h2 className={cockpit.sectionTitle}>{t("devices.title")}</h2>
      {KINDS.map((kind) => {
        const paired = session.devices.filter((device) => device.kind === kind);
        if (paired.length === 0) {
          return (
            <Unpaired
              key={kind}
              sessionId={session.id}
              kind={kind}
              onPair={() => setPairing(kind)}
            />
          );
        }
        return paired.map((device) => (
          <Paired
            key={device.id}
            sessionId={session.id}
            device={device}
            says={device.connected ? doing(session, kind) : null}
            canAct={
              kind === "headset" &&
              device.self_test === null &&
              (!device.connected || session.status === "planned")
            }
            onPair={() => setPairing(kind)}
          />
        ));
      })}
      <PairingDialog session={session} device={pairing} onClose={() => setPairing(null)} />
    </section>
  );
}

interface UnpairedProps {
  readonly sessionId: string;
  readonly kind: Device;
  readonly onPair: () => void;
}

function Unpaired({ sessionId, kind, onPair }: UnpairedProps) {
  const { t } = useTexts();
  return (
    <div className={classes.device}>
      <Icon name={kind} size={22} />
      <div>
        <div className={classes.deviceName}>
          {t(`device.${kind}`)} <Key name={PAIR_KEYS[kind]} />
        </div>
        <div className={classes.deviceState}>{t("device.unpaired")}</div>
        {kind === "headset" && <OpenDesktop sessionId={sessionId} />}
      </div>
      <Button
        size="xs"
        variant="light"
        onClick={onPair}
        aria-label={t(`device.pair.${kind}`)}
        aria-keyshortcuts={PAIR_KEYS[kind]}
      >
        {t("device.pair")}
      </Button>
    </div>
  );
}

/** Pairs this browser as the headset, and opens the study on this screen in a tab of its own. */
function OpenDesktop({ sessionId }: { readonly sessionId: string }) {
  const { t } = useTexts();
  const pair = useOpenOnScreen();
  return (
    <Button
      size="compact-xs"
      variant="subtle"
      loading={pair.isPending}
      title={t("device.desktop.title")}
      onClick={() => pair.mutate({ sessionId, tab: opened() })}
    >
      {t("device.desktop")}
    </Button>
  );
}

/** Keys that show a pairing code; a connected device is replaced by the next one to use it. */
function usePairKeys(pair: (kind: Device) => void): void {
  useEffect(() => {
    const onKey = (event: KeyboardEvent) => {
      const kind = KINDS.find((one) => PAIR_KEYS[one] === event.key.toUpperCase());
      if (kind === undefined || event.repeat || isBusy(event)) return;
      event.preventDefault();
      pair(kind);
    };
    document.addEventListener("keydown", onKey);
    return () => document.removeEventListener("keydown", onKey);
  }, [pair]);
}

interface PairedProps {
  readonly sessionId: string;
  readonly device: PairedDevice;
  /** What the person at it is doing; null if that is not known. */
  readonly says: Doing | null;
  /** Whether this screen may take its place: not that of a headset that somebody may wear. */
  readonly canAct: boolean;
  readonly onPair: () => void;
}

function Paired({ sessionId, device, says, canAct, onPair }: PairedProps): JSX.Element {
  const { t, language } = useTexts();
  const now = useSlowClock();
  const revoke = useMutation({ mutationFn: () => sessions.revoke(sessionId, device.id) });
  const lastSeen = device.last_seen_at === null ? null : ago(device.last_seen_at, now, language);
  return (
    <div className={classes.device}>
      <Icon name={device.kind} size={22} />
      <div>
        <div className={classes.deviceName}>{device.name || t(`device.${device.kind}`)}</div>
        {device.self_test !== null ? (
          <div className={classes.deviceState}>
            <Icon name="clock" size={16} />
            <SelfTest key={device.self_test.left_s} leftS={device.self_test.left_s} />
          </div>
        ) : (
          <div className={`${classes.deviceState} ${device.connected ? "" : classes.lost}`}>
            <ConnectionMark connected={device.connected} />
            {device.connected ? t("device.connected") : t("device.lost")}
            {says !== null && ` · ${t(`device.says.${says}`)}`}
            {!device.connected && lastSeen !== null && ` · ${lastSeen}`}
          </div>
        )}
        {canAct && <OpenDesktop sessionId={sessionId} />}
      </div>
      {device.connected ? (
        <ActionIcon
          variant="subtle"
          color="gray"
          loading={revoke.isPending}
          aria-label={t(`device.revoke.${device.kind}`)}
          title={t(`device.revoke.${device.kind}`)}
          onClick={() => revoke.mutate()}
        >
          <Icon name="close" size={16} />
        </ActionIcon>
      ) : (
        <Button
          size="xs"
          variant="light"
          onClick={onPair}
          aria-label={t(`device.pair.${device.kind}`)}
        >
          {t("device.pair")}
        </Button>
      )}
    </div>
  );
}

/** What is left of the test that a headset makes of itself, counted down from when it was told. */
function SelfTest({ leftS }: { readonly leftS: number | null }): JSX.Element {
  const { t } = useTexts();
  const [toldAt] = useState(() => performance.now());
  const [now, setNow] = useState(toldAt);
  useEffect(() => {
    const timer = setInterval(() => setNow(performance.now()), 1000);
    return () => clearInterval(timer);
  }, []);
  if (leftS === null) return <>{t("device.selfTest.opens")}</>;
  const left = Math.ceil(leftS - (now - toldAt) / 1000);
  if (left <= 0) return <>{t("device.selfTest.ends")}</>;
  return <>{t("device.selfTest", { left: duration(seconds(left)) })}</>;
}

/** The time of day, updated every five seconds: enough for "last seen". */
function useSlowClock(): Date {
  const [now, setNow] = useState(() => new Date());
  useEffect(() => {
    const timer = setInterval(() => setNow(new Date()), 5000);
    return () => clearInterval(timer);
  }, []);
  return now;
}
