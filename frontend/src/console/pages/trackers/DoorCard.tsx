/** A door: its state, where senders reach it, and how it is opened. */
import { Button, NativeSelect, NumberInput, Paper, Switch, TextInput, Title } from "@mantine/core";
import { type Door, type DoorWish, trackers } from "@shared/api/trackers";
import { dateTime } from "@shared/format";
import { Icon, type IconName } from "@shared/ui/Icon";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { usePermissions } from "../../permissions";
import { trackersQuery } from "../../queries";
import { Copyable } from "../network/Copyable";
import { actorName } from "../people/auditWords";
import { CloseDoor } from "./CloseDoor";
import classes from "./Trackers.module.css";

type State = "closed" | "opening" | "open" | "failed" | "waiting";

const ICONS: Readonly<Record<State, IconName>> = {
  closed: "lock",
  opening: "clock",
  open: "check",
  failed: "alert",
  waiting: "alert",
};

function stateOf(door: Door): State {
  if (!door.is_open || door.state === null) return "closed";
  return door.door === "natnet" && door.state === "open" && door.packets === 0
    ? "waiting"
    : door.state;
}

interface DoorCardProps {
  readonly door: Door;
  readonly interfaces: readonly string[];
}

export function DoorCard({ door, interfaces }: DoorCardProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const canSet = usePermissions()("openDoor");
  const state = stateOf(door);
  const name = t(`trackers.door.${door.door}`);
  const set = useMutation({
    mutationFn: (wish: DoorWish) => trackers.setDoor(door.door, wish),
    onSuccess: (all) => queries.setQueryData(trackersQuery.queryKey, all),
  });
  return (
    <Paper className={classes.door ?? ""} component="section" aria-label={name}>
      <div className={classes.doorHead}>
        <Title order={3}>{name}</Title>
        <span className={`${classes.state} ${classes[state]}`}>
          <Icon name={ICONS[state]} size={14} />
          {t(`trackers.state.${state}`)}
        </span>
      </div>
      <p className={classes.by}>{t(`trackers.door.${door.door}.by`)}</p>
      {door.is_open ? <Opened door={door} /> : null}
      {set.isError && <Failure error={set.error} />}
      {canSet && door.is_open && (
        <CloseDoor
          door={door.door}
          name={name}
          isClosing={set.isPending}
          onClose={() => set.mutate({ ...settings(door), is_open: false })}
        />
      )}
      {canSet && !door.is_open && (
        <Opening
          door={door}
          name={name}
          interfaces={interfaces}
          pending={set.isPending}
          onOpen={(wish) => set.mutate(wish)}
        />
      )}
    </Paper>
  );
}

const settings = ({ interface: own, port, server, multicast }: Door) => ({
  interface: own,
  port,
  server,
  multicast,
});

/** What to enter elsewhere, who opened it, what is wrong, and what came in. */
function Opened({ door }: { readonly door: Door }): JSX.Element {
  const { t, language } = useTexts();
  const isNatNet = door.door === "natnet";
  const counts = (["dropped", "unread", "foreign"] as const).flatMap((key) => {
    const count = door[key] ?? 0;
    return count > 0 ? [t(`trackers.${key}`, { count })] : [];
  });
  return (
    <>
      <p className={classes.enter}>{t(isNatNet ? "trackers.asks" : "trackers.enter")}</p>
      <Copyable text={`${isNatNet ? door.server : door.interface}:${door.port}`} />
      {door.trouble !== null && (
        <p className={classes.trouble}>
          {t(`trackers.trouble.${door.trouble}`, {
            port: door.port,
            interface: door.interface,
            detail: door.trouble_detail,
          })}{" "}
          {t("trackers.retries")}
        </p>
      )}
      <p className={`${classes.counts} numbers`}>
        {[t("trackers.packets", { count: door.packets }), ...counts].join(" · ")}
      </p>
      {door.opened_at !== null && (
        <p className={classes.by}>
          {t(door.resumed ? "trackers.resumed" : "trackers.openedBy", {
            by: actorName(door.opened_by ?? ""),
            at: dateTime(door.opened_at, language),
          })}
        </p>
      )}
    </>
  );
}

interface OpeningProps {
  readonly door: Door;
  readonly name: string;
  readonly interfaces: readonly string[];
  readonly pending: boolean;
  readonly onOpen: (wish: DoorWish) => void;
}

/** The fields of a closed door. */
function Opening({ door, name, interfaces, pending, onOpen }: OpeningProps): JSX.Element {
  const { t } = useTexts();
  const [own, setOwn] = useState(
    interfaces.includes(door.interface) ? door.interface : (interfaces[0] ?? door.interface),
  );
  const [port, setPort] = useState<number | string>(door.port);
  const [server, setServer] = useState(door.server ?? "");
  const [multicast, setMulticast] = useState(door.multicast);
  const isNatNet = door.door === "natnet";
  const ready = typeof port === "number" && (!isNatNet || server.trim() !== "");
  return (
    <form
      className={classes.fields}
      onSubmit={(event) => {
        event.preventDefault();
        if (typeof port !== "number" || !ready) return;
        const motive = isNatNet ? server.trim() : null;
        onOpen({ is_open: true, interface: own, port, server: motive, multicast });
      }}
    >
      <NativeSelect
        label={t("trackers.interface")}
        value={own}
        onChange={(event) => setOwn(event.currentTarget.value)}
        data={interfaces.map((address) => ({
          value: address,
          label:
            address === interfaces[0] ? t("trackers.interface.loopback", { address }) : address,
        }))}
      />
      {isNatNet && (
        <TextInput
          label={t("trackers.server")}
          placeholder="192.168.1.20"
          value={server}
          onChange={(event) => setServer(event.currentTarget.value)}
        />
      )}
      <NumberInput
        label={t(isNatNet ? "trackers.server.port" : "trackers.port")}
        value={port}
        onChange={setPort}
        min={1024}
        max={65535}
        allowDecimal={false}
        hideControls
      />
      {isNatNet && (
        <Switch
          label={t("trackers.multicast")}
          description={t("trackers.multicast.hint")}
          checked={multicast}
          onChange={(event) => setMulticast(event.currentTarget.checked)}
        />
      )}
      <Button
        type="submit"
        disabled={!ready}
        loading={pending}
        aria-label={t("trackers.openDoor", { door: name })}
      >
        {t("trackers.open")}
      </Button>
    </form>
  );
}
