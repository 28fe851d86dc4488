/** One slot of the ledger: its state, its participant, and all attempts on request. */
import { Popover } from "@mantine/core";
import type { Attempt, Slot } from "@shared/api/types";
import { dateTime } from "@shared/format";
import { type JSX, useState } from "react";
import { Link } from "wouter";
import { useTexts } from "../../i18n";
import { Shortfalls } from "../../ui/Shortfalls";
import { SlotMark } from "../../ui/SlotMark";
import classes from "./LedgerTab.module.css";

interface SlotCellProps {
  readonly slot: Slot;
  readonly next: boolean;
}

export function SlotCell({ slot, next }: SlotCellProps): JSX.Element {
  const [opened, setOpened] = useState(false);
  const className = `${classes.slot} ${next ? classes.next : ""}`;
  if (slot.attempts.length === 0) {
    return (
      <div className={className}>
        <SlotText slot={slot} next={next} />
      </div>
    );
  }
  return (
    <Popover
      opened={opened}
      onChange={setOpened}
      width={320}
      position="bottom-start"
      withArrow
      trapFocus
    >
      <Popover.Target>
        <button type="button" className={className} onClick={() => setOpened(!opened)}>
          <SlotText slot={slot} next={next} />
        </button>
      </Popover.Target>
      <Popover.Dropdown>
        <ol className={classes.attempts}>
          {slot.attempts.map((attempt) => (
            <AttemptText key={attempt.session_id} attempt={attempt} />
          ))}
        </ol>
      </Popover.Dropdown>
    </Popover>
  );
}

function SlotText({ slot, next }: SlotCellProps): JSX.Element {
  const { t } = useTexts();
  const last = slot.state === "free" ? undefined : slot.attempts.at(-1);
  const earlier = slot.attempts.length - (last === undefined ? 0 : 1);
  return (
    <>
      <SlotMark state={slot.state} />
      <span>
        <span className={classes.code} title={last?.participant_code}>
          {last?.participant_code ?? t(next ? "slot.next" : "slot.free")}
          {last !== undefined && (
            <span className="visually-hidden">, {t(`slot.${slot.state}`)}</span>
          )}
        </span>
        {earlier > 0 && (
          <span className={classes.sub}>{t("slot.earlier", { count: earlier })}</span>
        )}
      </span>
    </>
  );
}

function AttemptText({ attempt }: { readonly attempt: Attempt }): JSX.Element {
  const { t, language } = useTexts();
  return (
    <li className={classes.attempt}>
      <Link href={`/sessions/${attempt.session_id}`}>{attempt.participant_code}</Link>
      <span className={classes.sub}>
        {t(`outcome.${attempt.outcome}`)} · {dateTime(attempt.opened_at, language)}
      </span>
      {attempt.reason !== null && <span className={classes.sub}>{attempt.reason}</span>}
      {attempt.shortfalls.length > 0 && (
        <div className={classes.sub}>
          <Shortfalls found={attempt.shortfalls} />
        </div>
      )}
      {attempt.outcome === "invalid" && attempt.shortfalls.length === 0 && (
        <span className={classes.sub}>{t("validity.slotGiven")}</span>
      )}
    </li>
  );
}
