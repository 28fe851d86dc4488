/** A source: whose clock it is on, what is wrong with its packets, and each of its trackers. */
import { NativeSelect, Table } from "@mantine/core";
import type { Performers } from "@shared/api/performers";
import { type LimbWish, type Source, type Tracker, trackers } from "@shared/api/trackers";
import { decimals, duration, measuredTime, number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { seconds } from "@shared/units";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { Failure } from "../../errors";
import { type Key, useTexts } from "../../i18n";
import { SkeletonList } from "../../performer/SkeletonList";
import { usePermissions } from "../../permissions";
import { trackersQuery } from "../../queries";
import classes from "./Trackers.module.css";

const COLUMNS = ["tracker", "rate", "gaps", "jitter", "height", "seen", "limb"] as const;
/** Without the limb, and without the height: most senders tell where a bone is in its parent. */
const BONE_COLUMNS = COLUMNS.filter((one) => one !== "limb" && one !== "height");
/** Seconds after which a tracker is no longer seen "now": between two requests of the page. */
const NOW_S = 1.5;

interface SourceSectionProps {
  readonly source: Source;
  readonly limbs: readonly string[];
  /** Undefined until they are known. */
  readonly skeletons: Performers | undefined;
}

export function SourceSection({ source, limbs, skeletons }: SourceSectionProps): JSX.Element {
  const { t } = useTexts();
  // Bones have their place in a skeleton already; only what is strapped on has a limb to choose.
  const isBone = (one: Tracker): boolean => one.kind === "bone" || one.kind === "root";
  const bones = source.trackers.filter(isBone);
  const worn = source.trackers.filter((one) => !isBone(one));
  return (
    <section className={classes.source} aria-label={`${source.name} ${source.address}`}>
      <div className={classes.sourceHead}>
        <h3>{source.name}</h3>
        <span className={classes.address}>
          {t(`trackers.door.${source.door}`)}, {source.address}
        </span>
        <span className={`${classes.state} ${source.is_silent ? classes.failed : classes.open}`}>
          <Icon name={source.is_silent ? "alert" : "check"} size={14} />
          {source.is_silent
            ? t("trackers.silent", { time: duration(seconds(source.silent_s)) })
            : t("trackers.sending")}
        </span>
      </div>
      {source.same_name && <Notice tone="warn">{t("trackers.sameName")}</Notice>}
      <Figures source={source} />
      {bones.length > 0 && skeletons !== undefined && (
        <SkeletonList source={source} all={skeletons} />
      )}
      {worn.length > 0 && <TrackerTable source={source} own={worn} limbs={limbs} />}
      {bones.length > 0 && (
        <details className={classes.bones}>
          <summary>{t("trackers.bones", { count: bones.length })}</summary>
          <TrackerTable source={source} own={bones} limbs={null} />
        </details>
      )}
    </section>
  );
}

/** The source's clock and counts; those that it does not let anybody know are a dash. */
function Figures({ source }: { readonly source: Source }): JSX.Element {
  const { t, language } = useTexts();
  const count = (value: number | null): string =>
    value === null ? t("trackers.unknown") : number(value, language, 0);
  const problems = Object.entries(source.problems).map(([kind, many]) =>
    t(`trackers.problem.${kind}` as Key, { count: many }),
  );
  const figures: readonly (readonly [Key, string])[] = [
    ["trackers.clock", clock()],
    ["trackers.received", count(source.packets)],
    ["trackers.doubled", count(source.doubled)],
    ["trackers.late", count(source.late)],
    ["trackers.skipped", count(source.skipped)],
    ["trackers.restarts", count(source.restarts)],
    ["trackers.problems", problems.length === 0 ? count(0) : problems.join(", ")],
  ];
  return (
    <dl className={`${classes.figures} numbers`}>
      {figures.map(([key, value]) => (
        <div key={key}>
          <dt>{t(key)}</dt>
          <dd>{value}</dd>
        </div>
      ))}
    </dl>
  );

  function clock(): string {
    if (source.offset_s === null) return t("trackers.clock.none");
    if (source.uncertainty_ms === null) return t("trackers.clock.measuring");
    // Never rounded down: a clock is not better known than it is.
    const value = decimals(Math.ceil(source.uncertainty_ms * 10) / 10, language, 1);
    return t("trackers.clock.within", { value });
  }
}

interface TrackerTableProps {
  readonly source: Source;
  readonly own: readonly Tracker[];
  /** The limbs to choose from; null where trackers are bones. */
  readonly limbs: readonly string[] | null;
}

function TrackerTable({ source, own, limbs }: TrackerTableProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const wear = useMutation({
    mutationFn: (wish: LimbWish) => trackers.setLimb(wish),
    onSuccess: (all) => queries.setQueryData(trackersQuery.queryKey, all),
  });
  const columns = limbs === null ? BONE_COLUMNS : COLUMNS;
  return (
    <>
      {wear.isError && <Failure error={wear.error} />}
      <div className={classes.frame}>
        <Table verticalSpacing={6} horizontalSpacing="md">
          <Table.Thead>
            <Table.Tr>
              {columns.map((column) => (
                <Table.Th key={column}>{t(`trackers.${column}`)}</Table.Th>
              ))}
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {own.map((one) => (
              <TrackerRow
                key={`${one.kind} ${one.name}`}
                one={one}
                limbs={limbs}
                onWear={(limb) =>
                  wear.mutate({ door: source.door, source: source.name, tracker: one.name, limb })
                }
              />
            ))}
          </Table.Tbody>
        </Table>
      </div>
    </>
  );
}

interface TrackerRowProps {
  readonly one: Tracker;
  readonly limbs: readonly string[] | null;
  readonly onWear: (limb: string | null) => void;
}

function TrackerRow({ one, limbs, onWear }: TrackerRowProps): JSX.Element {
  const { t, language } = useTexts();
  const canWear = usePermissions()("wearTracker");
  const figure = (value: number | null | undefined, digits: number): string =>
    value === null || value === undefined
      ? t("trackers.unknown")
      : decimals(value, language, digits);
  const longest =
    one.gaps === 0 ? "" : ` (${measuredTime(seconds(one.longest_gap_ms / 1000), language)})`;
  return (
    <Table.Tr>
      <Table.Td>
        <span className={classes.name}>{one.name}</span>{" "}
        <span className={classes.kind}>
          {t(`trackers.kind.${one.kind}`)}
          {!one.tracked && `, ${t("trackers.lost")}`}
        </span>
      </Table.Td>
      <Table.Td className="numbers">{figure(one.rate_hz, 1)}</Table.Td>
      <Table.Td className="numbers">
        {number(one.gaps, language, 0)}
        {longest}
      </Table.Td>
      <Table.Td className="numbers">{figure(one.jitter_ms, 1)}</Table.Td>
      {limbs !== null && <Table.Td className="numbers">{figure(one.position_m?.[1], 2)}</Table.Td>}
      <Table.Td className="numbers">
        {one.silent_s < NOW_S
          ? t("trackers.seen.now")
          : t("trackers.seen.ago", { time: duration(seconds(one.silent_s)) })}
      </Table.Td>
      {limbs !== null && (
        <Table.Td>
          {canWear ? (
            <NativeSelect
              size="xs"
              aria-label={t("trackers.limbOf", { tracker: one.name })}
              value={one.limb ?? ""}
              onChange={(event) => onWear(event.currentTarget.value || null)}
              data={[
                { value: "", label: t("trackers.limb.none") },
                ...limbs.map((limb) => ({ value: limb, label: t(`joint.${limb}` as Key) })),
              ]}
            />
          ) : (
            t(one.limb === null ? "trackers.limb.none" : (`joint.${one.limb}` as Key))
          )}
        </Table.Td>
      )}
    </Table.Tr>
  );
}
