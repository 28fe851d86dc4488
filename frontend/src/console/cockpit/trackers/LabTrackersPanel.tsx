/** The lab's trackers that the session's headset uses: chosen, aligned by looking around, stored. */
import { NativeSelect, Progress } from "@mantine/core";
import { type SessionTrackers, trackers } from "@shared/api/trackers";
import type { SessionView } from "@shared/api/types";
import { decimals, number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link } from "wouter";
import { Failure } from "../../errors";
import { type Key, useTexts } from "../../i18n";
import { sessionTrackersQuery } from "../../queries";
import cockpit from "../Cockpit.module.css";
import live from "../Live.module.css";
import { ClosedDoor, useIsDoorClosed } from "./ClosedDoor";
import classes from "./LabTrackersPanel.module.css";

type Choice = SessionTrackers["choices"][number];

/** Nothing is shown in a lab that has no trackers: neither chosen nor sending. */
export function LabTrackersPanel({ session }: { readonly session: SessionView }): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const query = sessionTrackersQuery(session.id);
  const { data: shown } = useQuery(query);
  const choose = useMutation({
    mutationFn: (wish: Pick<SessionTrackers, "door" | "source">) =>
      trackers.choose(session.id, wish),
    onSuccess: (all) => queries.setQueryData(query.queryKey, all),
  });
  if (shown === undefined || (shown.source === null && shown.choices.length === 0)) return <></>;
  const choices = choicesOf(shown);
  const chosen = choices.findIndex(
    ({ door, source }) => door === shown.door && source === shown.source,
  );
  return (
    <section aria-label={t("lab.title")}>
      <h2 className={cockpit.sectionTitle}>{t("lab.title")}</h2>
      <NativeSelect
        size="xs"
        label={t("lab.source")}
        value={String(chosen)}
        disabled={choose.isPending}
        data={[
          { value: "-1", label: t("lab.none") },
          ...choices.map(({ source, is_silent }, at) => ({
            value: String(at),
            label: is_silent ? t("lab.silentSource", { source }) : source,
          })),
        ]}
        onChange={({ currentTarget }) => {
          const { door, source } = choices[Number(currentTarget.value)] ?? {
            door: null,
            source: null,
          };
          choose.mutate({ door, source });
        }}
      />
      {choose.error !== null && <Failure error={choose.error} />}
      {shown.status === null || shown.status === undefined ? (
        <p className={live.soft}>{t("lab.help")}</p>
      ) : (
        <InUse shown={shown} isSilent={choices[chosen]?.is_silent ?? false} />
      )}
      <Link href="/trackers" className={live.soft ?? ""}>
        {t("lab.page")}
      </Link>
    </section>
  );
}

/** The sources that send, and the chosen one also while it does not. */
function choicesOf({ door, source, choices }: SessionTrackers): readonly Choice[] {
  const isListed = choices.some((one) => one.door === door && one.source === source);
  if (door === null || source === null || isListed) return choices;
  return [...choices, { door, source, is_silent: true, limbs: 0, has_reference: false }];
}

interface InUseProps {
  readonly shown: SessionTrackers;
  readonly isSilent: boolean;
}

function InUse({ shown, isSilent }: InUseProps): JSX.Element {
  const { t, language } = useTexts();
  const { status, looking, problem, others = [], doubled = [], waiting_lost = 0 } = shown;
  const isAligned = status === "aligned";
  const isClosed = useIsDoorClosed(shown.door, isSilent);
  return (
    <>
      {isClosed && shown.door !== null ? (
        <ClosedDoor door={shown.door} />
      ) : (
        <>
          <output className={live.status}>
            <Icon name={isAligned ? "check" : "alert"} size={14} />
            {t(`lab.status.${status}` as Key)}
          </output>
          {!isAligned && <p className={live.soft}>{t(`lab.status.${status}.do` as Key)}</p>}
        </>
      )}
      {status === "looking" && looking != null && (
        <>
          <Progress value={100 * looking.progress} aria-label={t("lab.status.looking")} />
          <p className={live.soft}>
            {t("lab.looked", {
              turn: number(looking.turn_deg, language, 0),
              nod: number(looking.nod_deg, language, 0),
            })}
            {problem != null && isSaid(problem) && <> {t(`lab.problem.${problem}`)}</>}
          </p>
        </>
      )}
      {others.length > 0 && (
        <Notice tone="warn" title={t("lab.others")}>
          {t("lab.others.body", { others: others.join(", ") })}
        </Notice>
      )}
      {doubled.map(({ limb, trackers: [used = "", ...rest] }) => (
        <Notice
          key={limb}
          tone="warn"
          title={t("lab.doubled", { limb: t(`joint.${limb}` as Key) })}
        >
          {t("lab.doubled.body", { used, others: rest.join(", ") })}
        </Notice>
      ))}
      {waiting_lost > 0 && <Notice tone="bad" title={t("lab.gaveUp", { count: waiting_lost })} />}
      <Figures shown={shown} />
      <Worn shown={shown} />
    </>
  );
}

const SAID = ["still", "turn", "nod", "unlike", "delay"] as const;
const isSaid = (problem: string): problem is (typeof SAID)[number] =>
  (SAID as readonly string[]).includes(problem);

function Figures({ shown }: { readonly shown: SessionTrackers }): JSX.Element {
  const { t, language } = useTexts();
  const { alignment, latency_ms, latency_p95_ms, refits = 0, stored = 0 } = shown;
  const one = (value: number) => decimals(value, language, 1);
  const rows: [Key, string][] = [];
  if (alignment != null) {
    rows.push(
      ["lab.foot", `± ${one(alignment.foot_mm)} mm`],
      ["lab.residual", `${one(alignment.residual_mm)} mm, ${one(alignment.residual_deg)}°`],
      ["lab.delay", `${one(alignment.delay_ms)} ms`],
      ["lab.drift", t("lab.perMinute", { value: one(alignment.drift_mm_min) })],
      [
        "lab.refits",
        t("lab.refits.value", { count: refits, ago: number(alignment.fitted_s, language, 0) }),
      ],
    );
  }
  if (latency_ms != null && latency_p95_ms != null) {
    const values = { median: one(latency_ms), p95: one(latency_p95_ms) };
    rows.push(["lab.latency", t("lab.latency.value", values)]);
  }
  if (stored > 0) rows.push(["lab.stored", number(stored, language, 0)]);
  return (
    <dl className={`${live.figures} numbers`}>
      {rows.map(([key, value]) => (
        <div key={key} style={{ display: "contents" }}>
          <dt>{t(key)}</dt>
          <dd>{value}</dd>
        </div>
      ))}
    </dl>
  );
}

function Worn({ shown }: { readonly shown: SessionTrackers }): JSX.Element {
  const { t } = useTexts();
  return (
    <table className={classes.trackers}>
      <thead>
        <tr>
          <th scope="col">{t("lab.limb")}</th>
          <th scope="col">{t("lab.tracker")}</th>
          <th scope="col">{t("lab.now")}</th>
        </tr>
      </thead>
      <tbody>
        {(shown.trackers ?? []).map(({ tracker, limb, used, tracked }) => (
          <tr key={tracker}>
            <th scope="row">{t(`joint.${limb}` as Key)}</th>
            <td>{tracker}</td>
            <td data-lost={used && !tracked}>
              {t(used ? (tracked ? "lab.tracked" : "lab.lost") : "lab.unused")}
            </td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}
