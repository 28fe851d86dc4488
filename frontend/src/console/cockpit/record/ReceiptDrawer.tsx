/** The receipt of a session: what its headset made, what is stored of it, and what is missing. */
import type { SessionReceipt, SessionView } from "@shared/api/types";
import { number } from "@shared/format";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { type Key, useTexts } from "../../i18n";
import { receiptQuery } from "../../queries";
import { Loaded } from "../../ui/Loaded";
import { RecordDrawer } from "../../ui/RecordDrawer";
import classes from "../Panels.module.css";
import { type Gap, shownGaps } from "./gaps";

type Stream = SessionReceipt["streams"][number];

interface ReceiptDrawerProps {
  readonly session: SessionView;
  readonly opened: boolean;
  readonly onClose: () => void;
}

export function ReceiptDrawer({ session, opened, onClose }: ReceiptDrawerProps): JSX.Element {
  const { t } = useTexts();
  return (
    <RecordDrawer title={t("receipt.title")} opened={opened} onClose={onClose}>
      <Receipt session={session} />
    </RecordDrawer>
  );
}

function Receipt({ session }: { readonly session: SessionView }): JSX.Element {
  const query = useQuery(receiptQuery(session.id, session.version));
  return (
    <Loaded query={query}>
      {(receipt) => <Found receipt={receipt} runs={session.ended_at === null} />}
    </Loaded>
  );
}

function Found({ receipt, runs }: { readonly receipt: SessionReceipt; readonly runs: boolean }) {
  const { t, language } = useTexts();
  const { streams, problems, chain, completions } = receipt;
  const count = (name: "stored" | "rederived") =>
    number(
      completions.reduce((sum, one) => sum + one[name], 0),
      language,
      0,
    );
  return (
    <div className={classes.receipt}>
      <p className={classes.empty}>{t("receipt.lead")}</p>
      <Notice
        tone={receipt.complete || runs ? "info" : "warn"}
        {...(receipt.complete && { icon: "check" as const })}
        title={t(
          receipt.complete ? "receipt.complete" : runs ? "receipt.growing" : "receipt.incomplete",
        )}
      >
        {problems.length > 0 && (
          <ul>
            {problems.map((problem) => (
              <li key={problem}>{problem}</li>
            ))}
          </ul>
        )}
      </Notice>
      {streams.length === 0 ? (
        <p className={classes.empty}>{t("receipt.empty")}</p>
      ) : (
        <Streams streams={streams} />
      )}
      <dl className={`${classes.score} numbers`}>
        <dt>{t("receipt.chain")}</dt>
        <dd>
          {chain.ok
            ? t("receipt.chain.ok", { count: chain.events })
            : t("receipt.chain.broken", { at: chain.broken_at ?? "" })}
        </dd>
        {completions.length > 0 && (
          <>
            <dt>{t("receipt.completions")}</dt>
            <dd>
              {t("receipt.completions.of", {
                stored: count("stored"),
                rederived: count("rederived"),
              })}
            </dd>
          </>
        )}
      </dl>
    </div>
  );
}

const COLUMNS = ["stream", "epoch", "sent", "stored", "missing", "flagged"] as const;

function Streams({ streams }: { readonly streams: readonly Stream[] }): JSX.Element {
  const { t } = useTexts();
  return (
    <>
      <table className={`${classes.table} numbers`} aria-label={t("receipt.streams")}>
        <thead>
          <tr>
            {COLUMNS.map((column) => (
              <th key={column} scope="col">
                {t(`receipt.${column}`)}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {[...streams].sort(inOrder).map((one) => (
            <Row key={`${one.stream} ${one.epoch}`} stream={one} />
          ))}
        </tbody>
      </table>
      <p className={classes.empty}>
        {t("receipt.flagged.hint")}
        {streams.some(({ flagged }) => flagged === null) && ` ${t("receipt.blinded")}`}
      </p>
    </>
  );
}

function Row({ stream }: { readonly stream: Stream }): JSX.Element {
  const { t, language } = useTexts();
  const whole = (count: number) => number(count, language, 0);
  const unit = stream.stream === "reports" ? "reports" : "frames";
  const counted = (count: number) => t(`receipt.count.${unit}`, { count });
  const { shown, more } = shownGaps(stream.gaps);
  const gap = ({ first, last }: Gap) =>
    first === last
      ? t("receipt.gap.one", { first: whole(first) })
      : t("receipt.gap.many", { first: whole(first), last: whole(last) });
  const where = [
    ...shown.map(gap),
    ...(more > 0 ? [t("receipt.gap.more", { count: more })] : []),
  ].join(", ");
  return (
    <tr data-stream={stream.stream}>
      <th scope="row">
        {t(NAMES[stream.stream] ?? "receipt.stream.reports")}
        {stream.missing > 0 && (
          <div className={classes.when}>
            {t("receipt.gap", { what: counted(stream.missing), where })}
            {stream.damaged > 0 && `; ${t("receipt.damaged", { what: counted(stream.damaged) })}`}
          </div>
        )}
      </th>
      <td>{stream.epoch}</td>
      <td className={classes.nowrap}>{counted(stream.sent)}</td>
      <td>{whole(stream.stored)}</td>
      <td>{whole(stream.missing)}</td>
      <td>{stream.flagged === null ? "–" : whole(stream.flagged)}</td>
    </tr>
  );
}

/** Run by run, the participant first. */
const inOrder = (one: Stream, other: Stream): number =>
  one.epoch - other.epoch || ORDER.indexOf(one.stream) - ORDER.indexOf(other.stream);

const NAMES: Readonly<Record<string, Key>> = {
  target: "receipt.stream.target",
  actual: "receipt.stream.actual",
  target_fingers: "receipt.stream.target_fingers",
  actual_fingers: "receipt.stream.actual_fingers",
  reports: "receipt.stream.reports",
};
const ORDER = Object.keys(NAMES);
