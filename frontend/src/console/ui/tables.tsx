/** Tables: lists of things, and the numbers behind a result. */
import { Table } from "@mantine/core";
import type { JSX, ReactNode } from "react";
import classes from "./ListTable.module.css";
import numbers from "./NumbersTable.module.css";

interface ListTableProps {
  readonly columns: readonly string[];
  /** Whether the last column, which has no title, contains the actions for a row. */
  readonly hasActions: boolean;
  readonly className?: string | undefined;
  readonly children: ReactNode;
}

/** A list as a table: the titles of its columns, and a row for each item. */
export function ListTable({
  columns,
  hasActions,
  className = "",
  children,
}: ListTableProps): JSX.Element {
  return (
    <div className={`${classes.frame} ${className}`}>
      <Table verticalSpacing="sm" horizontalSpacing="md">
        <Table.Thead>
          <Table.Tr>
            {columns.map((column) => (
              <Table.Th key={column}>{column}</Table.Th>
            ))}
            {hasActions && <Table.Td />}
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>{children}</Table.Tbody>
      </Table>
    </div>
  );
}

interface ScrollBoxProps {
  readonly label: string;
  readonly className?: string | undefined;
  readonly children: ReactNode;
}

/** What may be wider than the window, such as a table: it scrolls sideways, also by keyboard. */
export function ScrollBox({ label, className = "", children }: ScrollBoxProps): JSX.Element {
  return (
    // biome-ignore lint/a11y/noNoninteractiveTabindex: scrollable content must be reachable with the keyboard
    <section className={`${numbers.scroll} ${className}`} aria-label={label} tabIndex={0}>
      {children}
    </section>
  );
}

interface NumbersTableProps {
  readonly label: string;
  readonly columns: readonly string[];
  readonly rows: readonly (readonly string[])[];
  readonly className?: string | undefined;
}

/** The numbers behind a result, as the server formatted them: column titles and rows of cells. */
export function NumbersTable({
  label,
  columns,
  rows,
  className = "",
}: NumbersTableProps): JSX.Element {
  return (
    <ScrollBox label={label} className={className}>
      <table className={`${numbers.table} numbers`}>
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
    </ScrollBox>
  );
}
