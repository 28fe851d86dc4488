/** The session's event log, event by event, as the server appended it. */
import type { AvatarChanges, SessionEvent, SessionView } from "@shared/api/types";
import { timeOfDay } from "@shared/format";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { changeWords } from "../../avatarChanges/words";
import { type Key, useTexts } from "../../i18n";
import { eventsQuery } from "../../queries";
import { stepName } from "../../steps";
import { Loaded } from "../../ui/Loaded";
import { RecordDrawer } from "../../ui/RecordDrawer";
import classes from "../Panels.module.css";

interface EventDrawerProps {
  readonly session: SessionView;
  readonly opened: boolean;
  readonly onClose: () => void;
}

export function EventDrawer({ session, opened, onClose }: EventDrawerProps): JSX.Element {
  const { t } = useTexts();
  return (
    <RecordDrawer title={t("log.title")} opened={opened} onClose={onClose}>
      <Events session={session} />
    </RecordDrawer>
  );
}

function Events({ session }: { readonly session: SessionView }): JSX.Element {
  const query = useQuery(eventsQuery(session.id, session.version));
  return (
    <Loaded query={query}>{(events) => <EventTable events={events} session={session} />}</Loaded>
  );
}

interface EventTableProps {
  readonly events: readonly SessionEvent[];
  readonly session: SessionView;
}

function EventTable({ events, session }: EventTableProps): JSX.Element {
  const { t, language } = useTexts();
  const stepWords = (index: number): string => {
    const step = session.steps[index];
    return step === undefined ? String(index + 1) : `${index + 1}, ${t(stepName(step))}`;
  };
  return (
    <>
      {events.some(({ hash }) => hash === null) && (
        <Notice tone="info" icon="lock">
          {t("blind.log")}
        </Notice>
      )}
      <table className={`${classes.table} numbers`}>
        <thead>
          <tr>
            <th scope="col">{t("log.number")}</th>
            <th scope="col">{t("log.time")}</th>
            <th scope="col">{t("log.event")}</th>
            <th scope="col">{t("log.by")}</th>
          </tr>
        </thead>
        <tbody>
          {[...events].reverse().map((event) => (
            <tr key={event.seq}>
              <td>{event.seq}</td>
              <td className={classes.nowrap}>{timeOfDay(event.at, language)}</td>
              <td>
                {nameOf(event, t)}
                <div className={classes.empty}>{detailsOf(event, stepWords)}</div>
                {event.type === "avatar_changed" && <Changed event={event} />}
              </td>
              <td className={classes.nowrap}>{actorName(event.by, t)}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </>
  );
}

/** An event's name; one of a newer server, which this page does not know, is named as stored. */
function nameOf({ type }: SessionEvent, t: ReturnType<typeof useTexts>["t"]): string {
  const key = `event.${type}`;
  const name = t(key as Key);
  return name === key ? type.replaceAll("_", " ") : name;
}

function Changed({ event }: { readonly event: SessionEvent }): JSX.Element {
  const texts = useTexts();
  const words = changeWords(texts, event.data.changes as AvatarChanges);
  const who = event.data.by === "study" ? "avatarChanges.study" : "avatarChanges.operator";
  if (words.length === 0) return <div>{texts.t("avatarChanges.back")}</div>;
  return (
    <div>
      {texts.t(who)}: {words.join(" · ")}
    </div>
  );
}

/** Identifiers and hashes are for the export, so they are not shown here. */
const MACHINE = /(_id|_hash|^by|hash)$/;

const detailsOf = (event: SessionEvent, stepWords: (index: number) => string): string =>
  Object.entries(event.data)
    .filter(([name, value]) => value !== null && typeof value !== "object" && !MACHINE.test(name))
    .map(([name, value]) =>
      name === "step" && typeof value === "number"
        ? `step ${stepWords(value)}`
        : `${wordOf(name)} ${readable(name, value)}`,
    )
    .join(" · ");

/** A unit at the end of a name. */
const UNIT = /_(s|ms|m|cm|deg|hz)$/;
const UNITS: Readonly<Record<string, string>> = { deg: "°", hz: "Hz" };

/** A name without its unit, in words: `active_s` is the active time. */
const wordOf = (name: string): string => {
  const bare = name.replace(UNIT, "");
  if (bare === "active") return "active time";
  return bare === "client_t" ? "headset's clock" : bare.replaceAll("_", " ");
};

/** A value as it is shown: at most three decimals, and the unit. */
function readable(name: string, value: unknown): string {
  if (typeof value !== "number") return String(value);
  const unit = UNIT.exec(name)?.[1];
  const rounded = String(Math.round(value * 1000) / 1000);
  return unit === undefined ? rounded : `${rounded} ${UNITS[unit] ?? unit}`;
}

/** The name of an actor: `account:admin` is admin; a device is called by its kind. */
function actorName(by: string, t: ReturnType<typeof useTexts>["t"]): string {
  const [kind = by, name = ""] = by.split(":");
  if (kind === "account") return name;
  return kind === "script" ? t("actor.script", { name }) : kind;
}
