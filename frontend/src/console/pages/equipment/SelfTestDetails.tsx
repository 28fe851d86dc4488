/** One self-test: its verdicts with limits and what to do, then every figure of the report. */
import { bytes, dateTime, decimals, duration, measuredTime, number } from "@shared/format";
import {
  concerns,
  errorsOf,
  inputsText,
  limitText,
  type SelfTestReport,
  type SelfTestView,
  todoText,
  valueText,
} from "@shared/selfTest/verdict";
import { Notice } from "@shared/ui/Notice";
import { seconds } from "@shared/units";
import type { JSX, ReactNode } from "react";
import { type Key, useTexts } from "../../i18n";
import classes from "./SelfTests.module.css";
import { VerdictMark } from "./VerdictMark";

export function SelfTestDetails({ test }: { readonly test: SelfTestView }): JSX.Element {
  const { t, language } = useTexts();
  const { report } = test;
  return (
    <div className={classes.details}>
      <h3>
        {report.device.name ?? t("selftest.unknownDevice")}, {dateTime(report.started_at, language)}
      </h3>
      <p className={classes.soft}>
        {t("selftests.ran", {
          duration: duration(seconds(report.duration_s)),
          inputs: inputsText(t, report),
          received: dateTime(test.received_at, language),
        })}
      </p>
      {test.clock_ahead_s !== null && (
        <Notice
          tone="warn"
          title={t("selftests.clock", { duration: duration(seconds(test.clock_ahead_s)) })}
        >
          {t("selftests.clock.body")}
        </Notice>
      )}
      {!test.worn && <Notice tone="info">{t("selftests.notWorn.body")}</Notice>}
      <Verdicts test={test} />
      {errorsOf(report).length > 0 && (
        <>
          <h4>{t("selftests.errors")}</h4>
          <ul>
            {errorsOf(report).map((error) => (
              <li key={error}>{error}</li>
            ))}
          </ul>
        </>
      )}
      <h3>{t("selftests.figures")}</h3>
      {partsOf(report, language).map(({ part, rows }) => (
        <Figures key={part} title={t(`selftests.part.${part}`)} rows={rows} />
      ))}
      <Tracking report={report} />
    </div>
  );
}

function Verdicts({ test }: { readonly test: SelfTestView }): JSX.Element {
  const { t, language } = useTexts();
  const listed = concerns(test.verdicts);
  const fine = test.verdicts.filter((verdict) => verdict.status === "ok");
  return (
    <table className={classes.table} aria-label={t("selftests.verdicts")}>
      <thead>
        <tr>
          <th scope="col">{t("selftest.figure")}</th>
          <th scope="col">{t("selftest.value")}</th>
          <th scope="col">{t("selftest.limit")}</th>
          <th scope="col">{t("selftests.verdict")}</th>
        </tr>
      </thead>
      <tbody>
        {[...listed, ...fine].map((verdict) => (
          <tr key={verdict.code} data-verdict={verdict.code}>
            <th scope="row">
              {t(`verdict.${verdict.code}`)}
              {verdict.status !== "ok" && (
                <div className={classes.soft}>{todoText(t, verdict, test.report.rendering)}</div>
              )}
            </th>
            <td className="numbers">{valueText(t, verdict, language)}</td>
            <td className="numbers">{limitText(t, verdict, language)}</td>
            <td>
              <VerdictMark status={verdict.status} />
            </td>
          </tr>
        ))}
      </tbody>
    </table>
  );
}

interface FiguresProps {
  readonly title: string;
  readonly rows: readonly Figure[];
}

function Figures({ title, rows }: FiguresProps): JSX.Element {
  const { t } = useTexts();
  return (
    <>
      <h4>{title}</h4>
      {rows.length === 0 && <p className={classes.soft}>{t("selftests.unmeasured")}</p>}
      <dl className={classes.figures}>
        {rows.map(([label, value]) => (
          <div key={label}>
            <dt>{t(label)}</dt>
            <dd className="numbers">
              {isKey(value) ? t(value.key) : (value ?? t("selftest.none"))}
            </dd>
          </div>
        ))}
      </dl>
    </>
  );
}

function Tracking({ report }: { readonly report: SelfTestReport }): JSX.Element {
  const { t, language } = useTexts();
  const percent = (share: number): string => `${decimals(100 * share, language, 1)} %`;
  const title = t("selftests.part.tracking");
  const columns = ["goal", "tracked", "inferred", "lost", "loss", "poses"] as const;
  const cells = (goal: keyof SelfTestReport["tracking"]): ReactNode[] => {
    const of = report.tracking[goal];
    if (of === undefined) return [];
    return [
      percent(of.tracked),
      percent(of.inferred),
      percent(of.lost),
      measuredTime(seconds(of.longest_loss_s), language),
      `${decimals(of.pose_rate_hz, language, 1)} Hz`,
    ].map((cell, at) => (
      <td key={columns[at + 1]} className="numbers">
        {cell}
      </td>
    ));
  };
  return (
    <>
      <h4>{title}</h4>
      <table className={classes.table} aria-label={title}>
        <thead>
          <tr>
            {columns.map((column) => (
              <th key={column} scope="col">
                {t(`selftests.${column}`)}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {GOALS.map((goal) => (
            <tr key={goal}>
              <th scope="row">{t(`selftests.goal.${goal}`)}</th>
              {cells(goal)}
            </tr>
          ))}
        </tbody>
      </table>
    </>
  );
}

const GOALS = ["Head", "LeftHand", "RightHand", "Hips", "LeftLowerLeg", "RightLowerLeg"] as const;

/** A label and its value: as text, as a word to look up, or null if it was not measured. */
type Figure = readonly [Key, string | { readonly key: Key } | null];
type Part = "rendering" | "physics" | "storage" | "page";

const isKey = (value: Figure[1]): value is { readonly key: Key } =>
  value !== null && typeof value !== "string";

interface PartFigures {
  readonly part: Part;
  readonly rows: readonly Figure[];
}

/** Every figure of a report apart from the tracking, in the order of the report. */
function partsOf(report: SelfTestReport, language: string): readonly PartFigures[] {
  const span = (time: number | null | undefined): string | null =>
    time == null ? null : measuredTime(seconds(time), language);
  const whole = (count: number | null | undefined): string | null =>
    count == null ? null : number(count, language, 0);
  const hz = (rate: number | null | undefined): string | null =>
    rate == null ? null : `${decimals(rate, language, 1)} Hz`;
  const size = (count: number | null | undefined): string | null =>
    count == null ? null : bytes(count, language);
  const { rendering, physics, storage, page } = report;
  return [
    {
      part: "rendering",
      rows: [
        ["selftests.mode", { key: `selftests.mode.${rendering.mode}` }],
        ["selftests.nominal", hz(rendering.nominal_rate_hz)],
        ["selftests.mean", hz(rendering.mean_rate_hz)],
        ["selftests.frames", whole(rendering.frames)],
        ["selftests.late", whole(rendering.late_frames)],
        ["selftests.p50", span(rendering.interval_p50_s)],
        ["selftests.p95", span(rendering.interval_p95_s)],
        ["selftests.p99", span(rendering.interval_p99_s)],
        ["selftests.longest", span(rendering.interval_longest_s)],
      ],
    },
    {
      part: "physics",
      rows:
        physics == null
          ? []
          : [
              ["selftests.where", { key: `selftests.where.${physics.where}` }],
              ["selftests.model", physics.model_hash.slice(0, 12)],
              ["selftests.stature", `${decimals(physics.stature_m, language, 2)} m`],
              ["selftests.simulated", measuredTime(seconds(physics.simulated_s), language)],
              ["selftests.speed", `${decimals(physics.real_time_factor, language, 2)} ×`],
              ["selftests.physics50", span(physics.frame_p50_s)],
              ["selftests.physics95", span(physics.frame_p95_s)],
              ["selftests.physics99", span(physics.frame_p99_s)],
              ["selftests.resets", whole(physics.resets)],
            ],
    },
    {
      part: "storage",
      rows:
        storage == null
          ? []
          : [
              ["selftests.batches", whole(storage.batches)],
              ["selftests.acknowledged", whole(storage.acknowledged)],
              ["selftests.bytes", size(storage.bytes)],
              ["selftests.throughput", `${bytes(storage.bytes_per_s, language)}/s`],
              ["selftests.trip50", span(storage.round_trip_p50_s)],
              ["selftests.trip95", span(storage.round_trip_p95_s)],
              ["selftests.tripLongest", span(storage.round_trip_longest_s)],
              ["selftests.journalWrites", whole(storage.journal_writes ?? 0)],
              ["selftests.journal95", span(storage.journal_write_p95_s)],
            ],
    },
    {
      part: "page",
      rows: [
        ["selftests.memory", size(page?.memory_bytes)],
        ["selftests.agent", report.device.user_agent],
      ],
    },
  ];
}
