/** The numbers behind a result, as they were written: names of columns, and rows of cells. */
import type { JSX } from "react";
import classes from "./NumbersTable.module.css";

interface NumbersTableProps {
  readonly label: string;
  readonly columns: readonly string[];
  readonly rows: readonly (readonly string[])[];
  readonly className?: string | undefined;
}

export function NumbersTable({
  label,
  columns,
  rows,
  className = "",
}: NumbersTableProps): JSX.Element {
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: what scrolls must be reached with the keyboard
    <section className={`${classes.scroll} ${className}`} aria-label={label} tabIndex={0}>
      <table className={`${classes.table} numbers`}>
        <thead>
          <tr>
            {columns.map((column) => (
              <th key={column} scope="col">
                {column}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {rows.map((row) => (
            <tr key={row.join("|")}>
              {row.map((cell, at) => (
                <td key={columns[at]}>{cell}</td>
              ))}
            </tr>
          ))}
        </tbody>
      </table>
    </section>
  );
}
