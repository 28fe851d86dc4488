/** A table of figures before and after, with their difference. */
import { decimals } from "@shared/format";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import classes from "../Editor.module.css";
import { DIGITS, differenceInWords } from "./figures";
import own from "./Tuning.module.css";

type Pair = readonly [before: number | undefined, after: number | undefined];

interface PairsTableProps {
  readonly label: string;
  /** The title of the first column. */
  readonly who: string;
  readonly figures: readonly (readonly [name: string, unit: string])[];
  readonly rows: readonly { readonly name: string; readonly pairs: readonly Pair[] }[];
}

export function PairsTable({ label, who, figures, rows }: PairsTableProps): JSX.Element {
  const { t, language } = useTexts();
  const figure = (value: number | undefined) =>
    value === undefined ? "–" : decimals(value, language, DIGITS);
  const columns = [
    t("avatars.before"),
    t("avatars.after"),
    t("avatars.compareOn.difference"),
  ] as const;
  const placeOf = (at: number) => (at === 0 ? `${own.figure} ${own.first}` : own.figure);
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: scrollable content must be reachable with the keyboard
    <section className={`${own.scroll} ${classes.losses}`} aria-label={label} tabIndex={0}>
      <table className={`${own.figures} numbers`}>
        <thead>
          <tr>
            <th rowSpan={2} scope="col">
              {who}
            </th>
            {figures.map(([name, unit]) => (
              <th key={name} scope="colgroup" colSpan={3} className={own.figure}>
                {name} <span className={own.unit}>({unit})</span>
              </th>
            ))}
          </tr>
          <tr>
            {figures.map(([name]) =>
              columns.map((column, at) => (
                <th key={`${name} ${column}`} scope="col" className={placeOf(at)}>
                  {column}
                </th>
              )),
            )}
          </tr>
        </thead>
        <tbody>
          {rows.map(({ name, pairs }) => (
            <tr key={name}>
              <th scope="row">{name}</th>
              {pairs.map(([old, next], pair) =>
                [old, next, differenceOf(old, next)].map((value, at) => (
                  <td key={`${figures[pair]?.[0]} ${columns[at]}`} className={placeOf(at)}>
                    {at === 2 ? differenceInWords(value, language) : figure(value)}
                  </td>
                )),
              )}
            </tr>
          ))}
        </tbody>
      </table>
    </section>
  );
}

const differenceOf = (old: number | undefined, next: number | undefined): number | undefined =>
  old === undefined || next === undefined ? undefined : next - old;
