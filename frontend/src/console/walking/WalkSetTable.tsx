/** The list of sets of walks: who walked, how many walks, how far. */
import { Table } from "@mantine/core";
import { type WalkSet, walking } from "@shared/api/walking";
import { decimals, number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { DeleteButton } from "./DeleteButton";
import { walkSetsQuery } from "./queries";
import classes from "./Walking.module.css";
import { CreatedCell, Synthetic, WalkingTable } from "./WalkingTable";

const COLUMNS = ["walks", "origin", "lengths", "durations", "by"] as const;

export function WalkSetTable({ sets }: { readonly sets: readonly WalkSet[] }): JSX.Element {
  return (
    <WalkingTable columns={COLUMNS}>
      {sets.map((set) => (
        <Row key={set.id} set={set} />
      ))}
    </WalkingTable>
  );
}

function Row({ set }: { readonly set: WalkSet }): JSX.Element {
  const { t, language } = useTexts();
  const canWrite = usePermissions()("walking");
  const { census, duration_s: duration, walks, people } = set.summary;
  // The same decimals in every row, so that sets can be compared.
  const n = (value: number) => decimals(value, language, 2);
  const [first, second, third] = census.quartiles_m;
  return (
    <Table.Tr>
      <Table.Td>
        <span className={classes.title}>{set.title}</span>{" "}
        {set.kind === "synthetic" && <Synthetic />}
        <span className={classes.sub}>
          {t("walking.walksOf", {
            walks: number(walks, language),
            people: number(people, language),
          })}
        </span>
        {(set.summary.assumed ?? []).map((text) => (
          <span key={text} className={classes.sub}>
            {t("walking.set.assumed", { text })}
          </span>
        ))}
        {(set.summary.doubts ?? []).map((text) => (
          <span key={text} className={classes.doubt}>
            <Icon name="alert" size={14} /> {t("walking.set.doubt", { text })}
          </span>
        ))}
      </Table.Td>
      <Table.Td>
        <Origin set={set} />
      </Table.Td>
      <Table.Td className="numbers">
        {t("walking.m", { value: n(second) })}
        <span className={classes.sub}>
          {t("walking.m.quartiles", { from: n(first), to: n(third) })}
        </span>
      </Table.Td>
      <Table.Td className="numbers">
        {t("walking.s", { value: n(duration.median) })}
        <span className={classes.sub}>
          {t("walking.s.range", { from: n(duration.low), to: n(duration.high) })}
        </span>
      </Table.Td>
      <CreatedCell at={set.at} by={set.by} />
      <Table.Td className={classes.rowActions ?? ""}>
        {canWrite && (
          <DeleteButton
            title={set.title}
            remove={() => walking.removeWalkSet(set.id)}
            changes={walkSetsQuery.queryKey}
          />
        )}
      </Table.Td>
    </Table.Tr>
  );
}

function Origin({ set }: { readonly set: WalkSet }): JSX.Element {
  const { t } = useTexts();
  const { origin } = set;
  switch (origin.kind) {
    case "population":
      return (
        <>
          {t("walking.origin.population", { name: origin.population })}
          <span className={classes.sub}>
            {t("walking.origin.seed", { seed: origin.seed ?? 1 })} ·{" "}
            {origin.scene ?? t("walking.origin.laboratory")}
          </span>
        </>
      );
    case "captures":
      return <>{t("walking.origin.captures", { count: origin.captures.length })}</>;
    default:
      return <>{origin.file_name}</>;
  }
}
