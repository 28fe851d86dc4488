/** The sessions that take the most room. */
import type { StorageRoom } from "@shared/api/housekeeping";
import { day } from "@shared/format";
import type { JSX } from "react";
import { Link } from "wouter";
import { useTexts } from "../i18n";
import { bytes } from "../ui/bytes";
import { KindBadge } from "../ui/KindBadge";
import classes from "./Storage.module.css";

export function LargestSessions({
  sessions,
}: {
  readonly sessions: StorageRoom["sessions"];
}): JSX.Element {
  const { t, language } = useTexts();
  if (sessions.length === 0) return <p className={classes.soft}>{t("storage.sessions.none")}</p>;
  return (
    <table className={`${classes.table} numbers`}>
      <thead>
        <tr>
          <th scope="col">{t("storage.session.participant")}</th>
          <th scope="col">{t("storage.session.kind")}</th>
          <th scope="col">{t("storage.session.made")}</th>
          <th scope="col">{t("storage.study.size")}</th>
        </tr>
      </thead>
      <tbody>
        {sessions.map((session) => (
          <tr key={session.id}>
            <td>
              <Link href={`/sessions/${session.id}`}>{session.participant_code}</Link>
              <span className={classes.about}>{session.study_key}</span>
            </td>
            <td>
              <KindBadge kind={session.kind} />
            </td>
            <td>{day(session.created_at, language)}</td>
            <td>{bytes(session.bytes, language)}</td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
