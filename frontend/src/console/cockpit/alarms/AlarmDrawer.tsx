/**
 * Every alarm of the session with its times, newest first; acknowledging an alarm does not remove
 * it.
 */
import type { Alarm, SessionView } from "@shared/api/types";
import { duration, timeOfDay } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { alarmsQuery } from "../../queries";
import { Loaded } from "../../ui/Loaded";
import { RecordDrawer } from "../../ui/RecordDrawer";
import classes from "../Panels.module.css";
import { type AlarmGroup, amount, fromRecord, groupsOf, stateOf, titleKey } from "./alarms";
import strip from "./SignalStrip.module.css";

interface AlarmDrawerProps {
  readonly session: SessionView;
  readonly opened: boolean;
  readonly onClose: () => void;
}

export function AlarmDrawer({ session, opened, onClose }: AlarmDrawerProps): JSX.Element {
  const { t } = useTexts();
  return (
    <RecordDrawer title={t("alarm.history")} opened={opened} onClose={onClose}>
      <History session={session} />
    </RecordDrawer>
  );
}

function History({ session }: { readonly session: SessionView }): JSX.Element {
  const { t } = useTexts();
  const query = useQuery(alarmsQuery(session.id, stateOf(session)));
  return (
    <Loaded query={query}>
      {(alarms) =>
        alarms.length === 0 ? (
          <p className={classes.empty}>{t("alarm.none")}</p>
        ) : (
          <>
            <p className={classes.empty}>{t("alarm.kept")}</p>
            <AlarmTable alarms={alarms} />
          </>
        )
      }
    </Loaded>
  );
}

function AlarmTable({ alarms }: { readonly alarms: readonly Alarm[] }): JSX.Element {
  const { t } = useTexts();
  return (
    <table className={`${classes.table} numbers`}>
      <thead>
        <tr>
          <th scope="col">{t("alarm.began")}</th>
          <th scope="col">{t("alarm.lasted")}</th>
          <th scope="col">{t("alarm.what")}</th>
        </tr>
      </thead>
      <tbody>
        {groupsOf(alarms).map((group) => (
          <AlarmRow key={group.newest.id} group={group} />
        ))}
      </tbody>
    </table>
  );
}

function AlarmRow({ group }: { readonly group: AlarmGroup }): JSX.Element {
  const { t, language } = useTexts();
  const { newest: alarm, count, since, lasted } = group;
  const shown = fromRecord(alarm);
  const amountText = amount(shown, language);
  const details = [
    t(`alarm.severity.${alarm.severity}`),
    alarm.stream === null ? null : t(`alarm.stream.${alarm.stream as "target" | "actual"}`),
    count === 1 ? null : t("alarm.times", { count, time: timeOfDay(alarm.since, language) }),
  ].filter((one) => one !== null);
  return (
    <tr>
      <td className={classes.nowrap}>{timeOfDay(since, language)}</td>
      <td className={classes.nowrap}>
        {alarm.cleared_at === null ? <strong>{t("alarm.still")}</strong> : duration(lasted)}
      </td>
      <td>
        <span className={strip[`row_${alarm.severity}`]}>
          <Icon name={alarm.severity === "info" ? "info" : "alert"} size={16} />
          {t(titleKey(shown))}
          {amountText !== null && ` · ${amountText}`}
        </span>
        <div className={classes.empty}>{details.join(" · ")}</div>
      </td>
    </tr>
  );
}
