/** The counterbalancing ledger: every order, every replicate, and who filled it. */
import type { Ledger, Slot, StudyDetail } from "@shared/api/types";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { ledgerQuery } from "../../queries";
import { useKind } from "../../ui/chosenKind";
import { EmptyState } from "../../ui/EmptyState";
import { KindFilter } from "../../ui/KindFilter";
import { Loaded } from "../../ui/Loaded";
import { Order, orderKey } from "../../ui/Order";
import { SlotMark } from "../../ui/SlotMark";
import { ScrollBox } from "../../ui/tables";
import classes from "./LedgerTab.module.css";
import { SlotCell } from "./SlotCell";
import page from "./StudyPage.module.css";

export function LedgerTab({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  const [kind, setKind] = useKind(study.key);
  return (
    <>
      <div className={page.toolbar}>
        <KindFilter kind={kind} onChange={setKind} />
        <div className={`${classes.legend} ${page.spacer}`}>
          {(["free", "open", "completed"] as const).map((state) => (
            <span key={state}>
              <SlotMark state={state} />
              {t(`slot.${state}`)}
            </span>
          ))}
        </div>
      </div>
      <p>{t(`ledger.lead.${kind}`)}</p>
      <Loaded query={useQuery(ledgerQuery(study.key, kind))}>
        {(ledger) => {
          if (ledger.slots.length === 0) {
            return (
              <EmptyState icon="list" title={t("ledger.empty.title")}>
                {t("ledger.empty.body")}
              </EmptyState>
            );
          }
          const grid = arrange(ledger);
          return grid === null ? <Blinded ledger={ledger} /> : <Grid grid={grid} ledger={ledger} />;
        }}
      </Loaded>
    </>
  );
}

/** The slots in the order of their use, for experimenters who may not know the orders. */
function Blinded({ ledger }: { readonly ledger: Ledger }): JSX.Element {
  const { t } = useTexts();
  const next = nextFree(ledger.slots);
  return (
    <>
      <p>{t("ledger.blinded")}</p>
      <ol className={classes.plain} aria-label={t("ledger.position")}>
        {ledger.slots.map((slot) => (
          <li key={slot.index}>
            <span className={classes.sub}>
              {t("ledger.slotNumber", { number: slot.index + 1 })}
            </span>
            <SlotCell slot={slot} next={slot.index === next} />
            {slot.sequence !== null && <Order sequence={slot.sequence} bodies={slot.bodies} />}
          </li>
        ))}
      </ol>
    </>
  );
}

interface GridProps {
  readonly grid: LedgerGrid;
  readonly ledger: Ledger;
}

function Grid({ grid, ledger }: GridProps): JSX.Element {
  const { t } = useTexts();
  const { rows, columns } = grid;
  const next = nextFree(ledger.slots);
  return (
    <ScrollBox label={t("ledger.order")} className={classes.scroll}>
      <table className={classes.grid}>
        <thead>
          <tr>
            <th scope="col">{t("ledger.order")}</th>
            {columns.map((column) => (
              <th key={column} scope="col">
                {t("ledger.replicate", { number: column })}
              </th>
            ))}
            <th scope="col">{t("ledger.balance")}</th>
          </tr>
        </thead>
        <tbody>
          {rows.map((row) => (
            <tr key={orderKey(row)}>
              <th scope="row">
                <Order sequence={row.sequence} bodies={row.bodies} />
              </th>
              {row.slots.map((slot, column) => (
                <td key={columns[column]}>
                  {slot !== undefined && <SlotCell slot={slot} next={slot.index === next} />}
                </td>
              ))}
              <td>
                <Balance slots={row.slots} />
              </td>
            </tr>
          ))}
        </tbody>
      </table>
    </ScrollBox>
  );
}

function Balance({ slots }: { readonly slots: readonly (Slot | undefined)[] }): JSX.Element {
  const { t } = useTexts();
  const present = slots.filter((slot) => slot !== undefined);
  const completed = present.filter((slot) => slot.state === "completed").length;
  const open = present.filter((slot) => slot.state === "open").length;
  const cells = [...present].sort((a, b) => RANK[a.state] - RANK[b.state]);
  return (
    <div className={classes.balance}>
      <div className={classes.bar} aria-hidden="true">
        {cells.map((slot) => (
          <span key={slot.index} className={`${classes.cell} ${CELLS[slot.state]}`} />
        ))}
      </div>
      <span className="numbers">
        {t("ledger.completedOf", { completed, total: present.length })}
        {open > 0 && <span className={classes.sub}>{t("ledger.openCount", { count: open })}</span>}
      </span>
    </div>
  );
}

const RANK = { completed: 0, open: 1, free: 2 } as const;
const CELLS = { completed: classes.cellDone, open: classes.cellOpen, free: "" } as const;

/** A row of the ledger's grid, which has a row for every order and a column for every replicate. */
interface LedgerRow {
  readonly sequence: readonly number[];
  readonly bodies: readonly (string | null)[] | null;
  /** One slot for each column; undefined if a replicate does not have such an order (yet). */
  readonly slots: readonly (Slot | undefined)[];
}

interface LedgerGrid {
  readonly rows: readonly LedgerRow[];
  readonly columns: readonly number[];
}

/** The grid; null if the orders are hidden or no slot exists yet. */
export function arrange(ledger: Ledger): LedgerGrid | null {
  const { sequences } = ledger;
  if (sequences === null || ledger.slots.length === 0) return null;
  const columns = [...new Set(ledger.slots.map((slot) => slot.replicate))].sort((a, b) => a - b);
  const place = (slot: Slot): string => `${orderKey(slot)}/${slot.replicate}`;
  const slots = new Map(ledger.slots.map((slot) => [place(slot), slot]));
  const rows = sequences.map((order) => ({
    sequence: order.sequence,
    bodies: order.bodies ?? null,
    slots: columns.map((column) => slots.get(`${orderKey(order)}/${column}`)),
  }));
  return { rows, columns };
}

/** The index of the slot the next participant gets; null if every slot is taken. */
export function nextFree(slots: readonly Slot[]): number | null {
  const free = slots.filter((slot) => slot.state === "free").map((slot) => slot.index);
  return free.length === 0 ? null : Math.min(...free);
}
