/** The list of sets of walks: who walked, how many walks, how far. */
import { Table } from "@mantine/core";
import { type Range, type WalkSet, walking } from "@shared/api/walking";
import { decimals, number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { DeleteButton } from "./DeleteButton";
import { namedNumber } from "./furtherNumbers";
import { walkSetsQuery } from "./queries";
import classes from "./Walking.module.css";
import { CreatedCell, Synthetic, WalkingTable } from "./WalkingTable";
import { useWalkedScenes } from "./walkedScenes";

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
        <WalkedWith set={set} />
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

/** Where the walks were, and the numbers that a model may depend on. */
function WalkedWith({ set }: { readonly set: WalkSet }): JSX.Element {
  const { t, language } = useTexts();
  const inScenes = useWalkedScenes();
  const {
    scenes,
    numbers,
    walks,
    changing_numbers: changing,
    spoilt_numbers: spoilt,
  } = set.summary;
  const n = (value: number) => number(value, language);
  const range = (name: string, { low, high }: Range) => {
    const { words, unit } = namedNumber(name);
    const values = low === high ? n(low) : t("walking.range", { from: n(low), to: n(high) });
    return [words, values, unit ?? []].flat().join(" ");
  };
  const known = Object.entries(numbers ?? {}).map(([name, one]) => {
    const some = t("walking.numbers.some", { some: n(one.walks), all: n(walks) });
    return one.walks < walks ? `${range(name, one.range)} ${some}` : range(name, one.range);
  });
  const named = (scenes ?? []).some(({ key }) => key !== null);
  return (
    <>
      {named && <span className={classes.sub}>{inScenes(scenes ?? [])}</span>}
      {known.length > 0 && <span className={classes.sub}>{known.join(" · ")}</span>}
      {(changing ?? []).length > 0 && (
        <span className={classes.sub}>
          {t("walking.numbers.changing", { names: (changing ?? []).join(", ") })}
        </span>
      )}
      {(spoilt ?? []).map((text) => (
        <span key={text} className={classes.doubt}>
          <Icon name="alert" size={14} /> {t("walking.numbers.spoilt", { text })}
        </span>
      ))}
    </>
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
