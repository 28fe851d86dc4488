/** Copies outside the database, and a button to record that one was destroyed. */
import { Button } from "@mantine/core";
import { type RemainingCopy, rights } from "@shared/api/rights";
import { dateTime } from "@shared/format";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import classes from "./Rights.module.css";

export function CopyList({ copies }: { readonly copies: readonly RemainingCopy[] }): JSX.Element {
  return (
    <ul className={classes.copies}>
      {copies.map((copy) => (
        <OneCopy key={copy.id} copy={copy} />
      ))}
    </ul>
  );
}

function OneCopy({ copy: listed }: { readonly copy: RemainingCopy }): JSX.Element {
  const { t, language } = useTexts();
  const queries = useQueryClient();
  const destroyed = useMutation({
    mutationFn: () => rights.destroyed(listed.id),
    onSuccess: () => queries.invalidateQueries({ queryKey: ["studies"] }),
  });
  // The list may be a snapshot, as after an erasure, so the answer to the click takes precedence.
  const copy: RemainingCopy = destroyed.data ?? listed;
  return (
    <li>
      <div>
        <div>
          <strong>{t(`copies.kind.${copy.kind}`)}</strong>, {dateTime(copy.at, language)}
        </div>
        <div className={classes.place}>{copy.place}</div>
        {copy.destroyed_at !== null && (
          <div className={classes.soft}>
            {t("copies.destroyed.on", {
              date: dateTime(copy.destroyed_at, language),
              by: (copy.destroyed_by ?? "").replace("account:", ""),
            })}
          </div>
        )}
        {destroyed.isError && <Failure error={destroyed.error} />}
      </div>
      {copy.destroyed_at === null && (
        <Button
          size="compact-sm"
          variant="default"
          aria-label={`${t("copies.destroyed")}: ${copy.place}`}
          loading={destroyed.isPending}
          onClick={() => destroyed.mutate()}
        >
          {t("copies.destroyed")}
        </Button>
      )}
    </li>
  );
}
