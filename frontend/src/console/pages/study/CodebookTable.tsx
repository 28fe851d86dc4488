/** The columns of one table of the export at a time. */
import { SegmentedControl } from "@mantine/core";
import type { CodebookColumn } from "@shared/api/types";
import { type JSX, useState } from "react";
import { useTexts } from "../../i18n";
import { ScrollBox } from "../../ui/tables";
import classes from "./ExportTab.module.css";

export function CodebookTable({
  columns,
}: {
  readonly columns: readonly CodebookColumn[];
}): JSX.Element {
  const { t } = useTexts();
  const tables = [...new Set(columns.map((column) => column.table))];
  const [chosen, setChosen] = useState(tables[0] ?? "");
  return (
    <>
      <SegmentedControl
        aria-label={t("export.table")}
        size="xs"
        mb="sm"
        classNames={{ root: classes.tables ?? "" }}
        withItemsBorders={false}
        value={chosen}
        onChange={setChosen}
        data={tables}
      />
      <ScrollBox label={t("export.codebook")}>
        <table className={classes.columns}>
          <thead>
            <tr>
              <th scope="col">{t("export.column")}</th>
              <th scope="col">{t("export.unit")}</th>
              <th scope="col">{t("export.meaning")}</th>
            </tr>
          </thead>
          <tbody>
            {columns
              .filter((column) => column.table === chosen)
              .map((column) => (
                <tr key={column.column}>
                  <td className={classes.name}>{column.column}</td>
                  <td className={classes.unit}>{column.unit === "" ? "–" : column.unit}</td>
                  <td>
                    {column.meaning}
                    {column.levels !== "" && (
                      <span className={classes.levels}>{column.levels}</span>
                    )}
                  </td>
                </tr>
              ))}
          </tbody>
        </table>
      </ScrollBox>
    </>
  );
}
