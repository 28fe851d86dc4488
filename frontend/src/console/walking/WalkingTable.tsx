/** A table of scenes, walks or models, and the cell that shows who created an entry, and when. */
import { Table } from "@mantine/core";
import { dateTime } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import type { JSX, ReactNode } from "react";
import { nameOf } from "../account";
import { useTexts } from "../i18n";
import { ListTable } from "../ui/tables";
import classes from "./Walking.module.css";

type Column = "title" | "state" | "on" | "walks" | "origin" | "lengths" | "durations" | "by";

interface WalkingTableProps {
  readonly columns: readonly Column[];
  readonly children: ReactNode;
}

export function WalkingTable({ columns, children }: WalkingTableProps): JSX.Element {
  const { t } = useTexts();
  return (
    <ListTable
      columns={columns.map((column) => t(`walking.column.${column}`))}
      hasActions
      className={classes.list}
    >
      {children}
    </ListTable>
  );
}

interface CreatedProps {
  readonly at: string;
  readonly by: string;
}

export function CreatedCell({ at, by }: CreatedProps): JSX.Element {
  const { language } = useTexts();
  return (
    <Table.Td>
      {dateTime(at, language)}
      <span className={classes.sub}>{nameOf(by)}</span>
    </Table.Td>
  );
}

/** A mark for walks, models and figures of synthetic walkers. */
export function Synthetic(): JSX.Element {
  const { t } = useTexts();
  return (
    <span className={classes.synthetic}>
      <Icon name="body" size={14} />
      {t("walking.synthetic")}
    </span>
  );
}
