/** Each study with its size, the mean of a session, and how many more fit. */
import { DEMO_KEY, type StorageRoom, type StudyRoom } from "@shared/api/housekeeping";
import { bytes, day, number } from "@shared/format";
import { inLanguage } from "@shared/text";
import type { JSX } from "react";
import { Link } from "wouter";
import { RemoveDemo } from "../home/DemoControls";
import { useDemo } from "../home/demo";
import { isThere } from "../home/demoState";
import { useTexts } from "../i18n";
import { KindBadge } from "../ui/badges";
import { ScrollBox } from "../ui/tables";
import { roundToTwoDigits } from "./figures";
import classes from "./Storage.module.css";

export function StudySizes({ studies }: { readonly studies: readonly StudyRoom[] }): JSX.Element {
  const { t } = useTexts();
  if (studies.length === 0) return <p className={classes.soft}>{t("storage.studies.none")}</p>;
  return (
    <>
      <ScrollBox label={t("storage.studies")}>
        <table className={`${classes.table} numbers`}>
          <thead>
            <tr>
              <th scope="col">{t("storage.study")}</th>
              <th scope="col">{t("storage.study.sessions")}</th>
              <th scope="col">{t("storage.study.size")}</th>
              <th scope="col">{t("storage.study.mean")}</th>
              <th scope="col">{t("storage.study.room")}</th>
            </tr>
          </thead>
          <tbody>
            {studies.map((study) => (
              <StudyRow key={study.key} study={study} />
            ))}
          </tbody>
        </table>
      </ScrollBox>
      <p className={classes.soft}>{t("storage.studies.note")}</p>
    </>
  );
}

function StudyRow({ study }: { readonly study: StudyRoom }): JSX.Element {
  const { t, language } = useTexts();
  const { mean_bytes: mean, measured_kind: kind, room_for: room } = study;
  const isRemovable = isThere(useDemo()) && study.key === DEMO_KEY;
  return (
    <tr>
      <td>
        <Link href={`/studies/${study.key}/sessions`}>{inLanguage(study.title, language)}</Link>
        <span className={classes.about}>{study.key}</span>
        {isRemovable && <RemoveDemo />}
      </td>
      <td>{number(study.sessions, language, 0)}</td>
      <td>{bytes(study.bytes, language)}</td>
      <td>
        {mean === null || kind === null ? (
          <span className={classes.about}>{t("storage.study.unmeasured")}</span>
        ) : (
          <>
            {bytes(mean, language)}
            <span className={classes.about}>
              {t("storage.study.mean.of", { count: study.measured, kind: t(`kind.${kind}`) })}
            </span>
          </>
        )}
      </td>
      <td>
        {room === null
          ? "–"
          : t("storage.study.room.of", { number: number(roundToTwoDigits(room), language, 0) })}
      </td>
    </tr>
  );
}

/** The sessions that take the most space. */
export function LargestSessions({
  sessions,
}: {
  readonly sessions: StorageRoom["sessions"];
}): JSX.Element {
  const { t, language } = useTexts();
  if (sessions.length === 0) return <p className={classes.soft}>{t("storage.sessions.none")}</p>;
  return (
    <ScrollBox label={t("storage.sessions")}>
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
    </ScrollBox>
  );
}
