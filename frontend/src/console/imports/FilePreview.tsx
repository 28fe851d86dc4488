/** The first rows of a file as they were read. */
import type { ImportLook } from "@shared/api/imports";
import type { JSX } from "react";
import { type Key, useTexts } from "../i18n";
import classes from "./Imports.module.css";

const SEPARATORS: Readonly<Record<string, Key>> = {
  ",": "imports.separator.comma",
  ";": "imports.separator.semicolon",
  "\t": "imports.separator.tab",
};

export function FilePreview({ look }: { readonly look: ImportLook }): JSX.Element {
  const { t } = useTexts();
  const separator = t(SEPARATORS[look.separator] ?? "imports.separator.comma");
  return (
    <details open={look.columns.length <= 12}>
      <summary className={classes.summary}>
        {t("imports.read", { rows: look.rows, columns: look.columns.length, separator })}
      </summary>
      {/* biome-ignore lint/a11y/noNoninteractiveTabindex: what scrolls must be reached with the keyboard */}
      <section className={classes.scroll} aria-label={t("imports.firstRows")} tabIndex={0}>
        <table className={`${classes.grid} numbers`}>
          <thead>
            <tr>
              {look.columns.map(({ name, label }) => (
                <th key={name} scope="col" title={label}>
                  {name}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {look.first_rows.map((row, line) => (
              // biome-ignore lint/suspicious/noArrayIndexKey: rows of a file have no other name
              <tr key={line}>
                {row.map((cell, at) => (
                  <td key={look.columns[at]?.name}>{cell}</td>
                ))}
              </tr>
            ))}
          </tbody>
        </table>
      </section>
    </details>
  );
}
