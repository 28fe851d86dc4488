/** A study's results in one row: how many of those planned, balance, quality, the main effect. */
import type { Measure, PrimaryResult } from "@shared/api/analysis";
import type { DataKind, Ledger, StudyDetail } from "@shared/api/types";
import { decimals } from "@shared/format";
import { useQuery } from "@tanstack/react-query";
import type { JSX, ReactNode } from "react";
import { Link } from "wouter";
import { useTexts } from "../../i18n";
import { ledgerQuery, preregistrationQuery, statisticsQuery } from "../../queries";
import { intervalOf } from "./AtAGlance";
import classes from "./SummaryRow.module.css";

interface SummaryRowProps {
  readonly study: StudyDetail;
  readonly kind: DataKind;
  /** What is drawn; undefined until something is. */
  readonly found: { readonly n_completed: number; readonly n_not_valid: number } | undefined;
  /** Newer sessions are being drawn: until then only the ledger knows how many have finished. */
  readonly isBehind?: boolean;
  /** What else is said of the numbers. */
  readonly note?: string | undefined;
}

export function SummaryRow({
  study,
  kind,
  found,
  isBehind = false,
  note,
}: SummaryRowProps): JSX.Element {
  const { t } = useTexts();
  const ledger = useQuery(ledgerQuery(study.key, kind)).data;
  const declared = useQuery(preregistrationQuery(study.key, kind)).data;
  const statistics = useQuery(statisticsQuery(study.key, kind)).data;
  const planned = declared?.declaration?.planned_n ?? ledger?.slots.length ?? null;
  const valid = found === undefined ? null : found.n_completed - found.n_not_valid;
  const finished = ledger?.slots.filter(({ state }) => state === "completed").length ?? 0;
  // What is drawn may be behind what the ledger has, and then says nothing of the study's state.
  const isDrawn = !isBehind || finished <= (valid ?? 0);
  return (
    <section className={classes.row} aria-label={t("summary.label")}>
      <Tile name={t("summary.n")} to={`/studies/${study.key}/ledger`}>
        <strong>{(isDrawn ? valid : finished) ?? "…"}</strong>{" "}
        {isDrawn
          ? planned !== null && planned > 0 && t("summary.ofPlanned", { planned })
          : t("summary.drawn")}
      </Tile>
      <Tile name={t("summary.balance")} to={`/studies/${study.key}/ledger`}>
        {ledger === undefined ? "…" : <Balance ledger={ledger} />}
      </Tile>
      <Tile name={t("summary.quality")} to={`/studies/${study.key}/sessions`}>
        <strong>{isDrawn && valid !== null ? valid : "…"}</strong>{" "}
        {isDrawn && found !== undefined && t("summary.valid", { count: found.n_completed })}
      </Tile>
      <Tile
        name={t(declared?.result == null ? "summary.effect" : "summary.primary")}
        to={`/studies/${study.key}/${declared?.result == null ? "statistics" : "preregistration"}`}
        wide
      >
        <MainEffect
          primary={declared?.result ?? null}
          measures={statistics?.measures ?? null}
          isCurrent={(statistics?.current ?? false) || (isDrawn && found?.n_completed === 0)}
        />
      </Tile>
      {note !== undefined && <p className={classes.note}>{note}</p>}
    </section>
  );
}

interface TileProps {
  readonly name: string;
  readonly to: string;
  readonly wide?: boolean;
  readonly children: ReactNode;
}

function Tile({ name, to, wide = false, children }: TileProps): JSX.Element {
  return (
    <Link href={to} className={wide ? `${classes.tile} ${classes.wide}` : (classes.tile ?? "")}>
      <span className={classes.name}>{name}</span>
      <span className={`${classes.value} numbers`}>{children}</span>
    </Link>
  );
}

/** How often each order has been completed: equally, or from how few to how many times. */
function Balance({ ledger }: { readonly ledger: Ledger }): JSX.Element {
  const { t } = useTexts();
  const times = new Map<string, number>();
  for (const { sequence, state } of ledger.slots) {
    const order = JSON.stringify(sequence);
    times.set(order, (times.get(order) ?? 0) + (state === "completed" ? 1 : 0));
  }
  const counts = [...times.values()];
  const least = Math.min(...counts);
  const most = Math.max(...counts);
  // In a blinded study the orders are not known here.
  if (counts.length === 0 || ledger.slots.some(({ sequence }) => sequence === null)) {
    return <>{t("summary.balance.unknown")}</>;
  }
  return (
    <>
      <strong>{least === most ? `${least}×` : `${least}–${most}×`}</strong>{" "}
      {t("summary.balance.each", { count: counts.length })}
    </>
  );
}

interface MainEffectProps {
  readonly primary: PrimaryResult | null;
  /** Null until they have been computed. */
  readonly measures: readonly Measure[] | null;
  /** Of all sessions: until then, what is missing may be there soon. */
  readonly isCurrent: boolean;
}

/** The preregistered test's words, else the first score's effect, which is exploratory. */
function MainEffect({ primary, measures, isCurrent }: MainEffectProps): JSX.Element {
  const { t, language } = useTexts();
  if (primary !== null) return <>{primary.sentence}</>;
  if (measures === null) return <>…</>;
  const [first] = measures.filter(({ effects }) => effects.length > 0);
  const effect = first?.effects[0];
  if (first === undefined || effect === undefined) {
    return <>{isCurrent ? t("summary.effect.none") : "…"}</>;
  }
  return (
    <>
      {first.title}, {effect.limb}, {effect.contrast}:{" "}
      <strong>
        {decimals(effect.difference, language, 2)} {first.unit}
      </strong>{" "}
      {effect.low !== null &&
        effect.high !== null &&
        t("summary.effect.interval", {
          interval: intervalOf(effect.low, effect.high, language),
          n: effect.n,
        })}
    </>
  );
}
