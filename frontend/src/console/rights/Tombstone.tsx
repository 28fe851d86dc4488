/** What an erasure removed, and what is left to do by hand. */
import { Button, Group, Stack } from "@mantine/core";
import type { Erasure } from "@shared/api/rights";
import { dateTime } from "@shared/format";
import { Notice } from "@shared/ui/Notice";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { CopyList } from "./CopyList";
import classes from "./Rights.module.css";

interface TombstoneProps {
  readonly erasure: Erasure;
  readonly onClose: () => void;
}

const REASONS = ["withdrawn", "requested", "retention", "mistake", "restored"] as const;

export function Tombstone({ erasure, onClose }: TombstoneProps): JSX.Element {
  const { t, language } = useTexts();
  const reason = REASONS.find((code) => code === erasure.reason_code);
  return (
    <Stack>
      <p className={classes.plain}>
        {t("rights.erased.on", {
          date: dateTime(erasure.at, language),
          by: erasure.by.replace("account:", ""),
        })}
        {reason !== undefined && `. ${t(`rights.reason.${reason}`)}.`}
      </p>
      {erasure.overwritten ? (
        <Notice tone="info" icon="check" title={t("tombstone.overwritten")} />
      ) : (
        <Notice tone="warn" title={t("tombstone.notOverwritten")}>
          {t("tombstone.notOverwritten.body")}
        </Notice>
      )}
      <div>
        <h3 className={classes.small}>{t("tombstone.removed")}</h3>
        <dl className={`${classes.removed} numbers`}>
          {Object.entries(erasure.removed).map(([table, count]) => (
            <div key={table}>
              <dt>{table.replaceAll("_", " ")}</dt>
              <dd>{t("tombstone.rows", { count })}</dd>
            </div>
          ))}
        </dl>
      </div>
      <div>
        <h3 className={classes.small}>{t("erase.copies")}</h3>
        {erasure.remaining.length === 0 ? (
          <p className={classes.soft}>{t("erase.copies.none")}</p>
        ) : (
          <CopyList copies={erasure.remaining} />
        )}
      </div>
      <Group justify="flex-end">
        <Button variant="default" onClick={onClose}>
          {t("action.close")}
        </Button>
      </Group>
    </Stack>
  );
}
