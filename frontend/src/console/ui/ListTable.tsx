/** A list as a table: the names of its columns, and a row for each thing. */
import { Table } from "@mantine/core";
import type { JSX, ReactNode } from "react";
import classes from "./ListTable.module.css";

interface ListTableProps {
  readonly columns: readonly string[];
  /** Whether the last column, which has no name, holds what can be done with a row. */
  readonly withDoing: boolean;
  readonly className?: string | undefined;
  readonly children: ReactNode;
}

export function ListTable({
  columns,
  withDoing,
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
            {withDoing && <Table.Td />}
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody>{children}</Table.Tbody>
      </Table>
    </div>
  );
}
