/** The values in which two configurations differ, by body group. */
import { number } from "@shared/format";
import type { JSX } from "react";
import { axisName } from "../avatarChanges/axes";
import { groupName, layerName } from "../avatarChanges/words";
import { type Key, useTexts } from "../i18n";
import numbers from "../ui/NumbersTable.module.css";
import { ScrollBox } from "../ui/tables";
import {
  type AvatarFile,
  type Compliance,
  type Difference,
  differences,
  FIELDS,
  type Field,
  UNITS,
} from "./axes";
import { changeOf, grouped } from "./differing";
import classes from "./Editor.module.css";
import { valueAt } from "./merge";

interface DifferencesProps {
  readonly label: string;
  readonly before: AvatarFile;
  readonly after: AvatarFile;
  readonly columns: readonly [before: string, after: string];
  /** The version that both began from, shown in a column before theirs. */
  readonly start?: { readonly column: string; readonly file: AvatarFile } | undefined;
}

export function Differences(props: DifferencesProps): JSX.Element {
  const { label, before, after, columns, start } = props;
  const texts = useTexts();
  const { t } = texts;
  const found = differences(before, after);
  if (found.length === 0) return <p className={classes.soft}>{t("avatars.same")}</p>;
  const titles = [
    t("avatars.what"),
    t("avatars.value"),
    ...(start === undefined ? [] : [start.column]),
    ...columns,
    t("avatars.compare.difference"),
    "%",
  ];
  return (
    <>
      <p className={`${classes.soft} numbers`}>
        {t("avatars.compare.count", { count: found.length })}
      </p>
      <ScrollBox label={label} className={`${classes.losses} ${classes.scrolls}`}>
        <table className={`${numbers.table} numbers`}>
          <thead>
            <tr>
              {titles.map((title) => (
                <th key={title} scope="col">
                  {title}
                </th>
              ))}
            </tr>
          </thead>
          {grouped(found).map(([group, rows]) => (
            <tbody key={group} aria-label={groupName(texts, group)}>
              {/* biome-ignore lint/a11y/noAriaHiddenOnFocusable: a row takes no focus; the group is named already, this is for the eye */}
              <tr aria-hidden="true">
                <th colSpan={titles.length} scope="rowgroup" className={classes.groupHead}>
                  {groupName(texts, group)} ({rows.length})
                </th>
              </tr>
              {rows.map((one) => {
                const [subject, field] = namesOf(one, texts);
                const began =
                  start === undefined ? [] : [inWords(valueAt(start.file, one.path), texts)];
                const cells = [
                  ...[subject, field, ...began],
                  ...[inWords(one.before, texts), inWords(one.after, texts)],
                  ...changeOf(one, texts.language),
                ];
                return (
                  <tr key={one.path.join(".")}>
                    {cells.map((cell, at) => (
                      <td key={titles[at]}>{cell}</td>
                    ))}
                  </tr>
                );
              })}
            </tbody>
          ))}
        </table>
      </ScrollBox>
    </>
  );
}

type Texts = ReturnType<typeof useTexts>;

const isField = (key: string): key is Field => FIELDS.includes(key as Field);

/** Who it concerns, and which value of theirs. */
function namesOf({ path }: Difference, texts: Texts): readonly [string, string] {
  const { t } = texts;
  const [first = "", second, third = ""] = path;
  if (first === "axes") {
    const field = isField(third) ? `${t(`avatars.field.${third}`)} (${UNITS[third]})` : third;
    return [axisName(texts, second ?? ""), field];
  }
  if (first === "compliance") {
    const field = t(`avatars.compliance.${third as keyof Compliance}`);
    return [groupName(texts, second ?? ""), third === "targets" ? field : `${field} (%)`];
  }
  const key = t(`avatars.key.${first}` as Key);
  if (second === undefined) return [t("bodyGroup.all"), key];
  return [first === "held_deg" ? axisName(texts, second) : groupName(texts, second), key];
}

const isPopulation = (value: unknown): value is AvatarFile["population"] =>
  value === "average" || value === "female" || value === "male";

/** Hashes are shortened to this many characters. */
const LONGEST = 16;

function inWords(value: unknown, texts: Texts): string {
  const { t, language } = texts;
  if (value === undefined || value === null) return "–";
  if (isPopulation(value)) return t(`avatars.population.${value}`);
  if (typeof value === "number") return number(value, language, 3);
  if (typeof value === "boolean") return t(value ? "avatarChanges.on" : "avatarChanges.off");
  if (Array.isArray(value)) return value.map((one) => entryInWords(one, texts)).join(", ") || "–";
  if (value === "joint" || value === "world") return t(`avatars.compliance.${value}`);
  if (typeof value !== "string") return JSON.stringify(value);
  return value.length > LONGEST ? `${value.slice(0, 12)}…` : value;
}

/** A body group in a cast, or a pair of layers that was switched. */
function entryInWords(entry: unknown, texts: Texts): string {
  if (typeof entry === "string") return groupName(texts, entry);
  const { layers, collide } = entry as NonNullable<AvatarFile["layers"]>[number];
  const names = layers.map((layer) => layerName(texts, layer)).join(" · ");
  return `${names}: ${texts.t(collide ? "avatarChanges.on" : "avatarChanges.off")}`;
}
