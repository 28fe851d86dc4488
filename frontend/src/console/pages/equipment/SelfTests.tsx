/** The self-tests of the lab's headsets, newest first, with a verdict each. */
import { Button, Drawer, Table } from "@mantine/core";
import { dateTime, decimals, measuredTime } from "@shared/format";
import { concerns, inputsText, type SelfTestView } from "@shared/selfTest/verdict";
import { seconds } from "@shared/units";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { useTexts } from "../../i18n";
import { selfTestsQuery } from "../../queries";
import { EmptyState } from "../../ui/EmptyState";
import { Loaded } from "../../ui/Loaded";
import { useShown } from "../../ui/page";
import { ListTable } from "../../ui/tables";
import { SelfTestDetails } from "./SelfTestDetails";
import classes from "./SelfTests.module.css";
import { VerdictMark } from "./VerdictMark";

const COLUMNS = ["when", "device", "rate", "physics", "roundTrip", "verdict"] as const;

export function SelfTests(): JSX.Element {
  const { t } = useTexts();
  const query = useQuery(selfTestsQuery);
  const [opened, setOpened] = useState<SelfTestView | null>(null);
  const shown = useShown(opened);
  return (
    <section className={classes.section} aria-labelledby="headset-tests">
      <h2 id="headset-tests">{t("selftests.title")}</h2>
      <p className={classes.lead}>{t("selftests.lead")}</p>
      <Loaded query={query}>
        {(all) =>
          all.length === 0 ? (
            <EmptyState icon="headset" title={t("selftests.empty")}>
              {t("selftests.empty.body")}
            </EmptyState>
          ) : (
            <ListTable columns={COLUMNS.map((column) => t(`selftests.${column}`))} hasActions>
              {all.map((one) => (
                <Row key={one.id} one={one} onOpen={() => setOpened(one)} />
              ))}
            </ListTable>
          )
        }
      </Loaded>
      <Drawer
        title={t("selftests.title")}
        position="right"
        size="xl"
        opened={opened !== null}
        onClose={() => setOpened(null)}
        closeButtonProps={{ "aria-label": t("action.close") }}
      >
        {shown !== null && <SelfTestDetails test={shown} />}
      </Drawer>
    </section>
  );
}

interface RowProps {
  readonly one: SelfTestView;
  readonly onOpen: () => void;
}

function Row({ one, onOpen }: RowProps): JSX.Element {
  const { t, language } = useTexts();
  const { device, rendering, physics, storage, started_at } = one.report;
  const name = device.name ?? t("selftest.unknownDevice");
  const trip = storage?.round_trip_p95_s;
  const none = <span className={classes.soft}>{t("selftest.none")}</span>;
  const when = dateTime(started_at, language);
  return (
    <Table.Tr>
      <Table.Td className="numbers">
        {when}
        {one.clock_ahead_s !== null && (
          <div className={classes.soft}>{t("selftests.clock.short")}</div>
        )}
      </Table.Td>
      <Table.Td>
        {name}
        <div className={classes.soft}>
          {one.worn ? inputsText(t, one.report) : t("selftests.notWorn")}
        </div>
      </Table.Td>
      <Table.Td className="numbers">
        {decimals(rendering.mean_rate_hz, language, 1)}
        {rendering.nominal_rate_hz != null && (
          <span className={classes.soft}>
            {" / "}
            {decimals(rendering.nominal_rate_hz, language, 0)}
          </span>
        )}
        {" Hz"}
      </Table.Td>
      <Table.Td className="numbers">
        {physics == null ? none : `${decimals(physics.real_time_factor, language, 1)} ×`}
      </Table.Td>
      <Table.Td className="numbers">
        {trip == null ? none : measuredTime(seconds(trip), language)}
      </Table.Td>
      <Table.Td>
        <VerdictMark status={one.status} />
        <div className={classes.soft}>{countText(t, one)}</div>
      </Table.Td>
      <Table.Td>
        <Button
          size="xs"
          variant="default"
          aria-label={t("selftests.details.of", { device: name, when })}
          onClick={onOpen}
        >
          {t("selftests.details")}
        </Button>
      </Table.Td>
    </Table.Tr>
  );
}

type Translate = ReturnType<typeof useTexts>["t"];

function countText(t: Translate, { verdicts }: SelfTestView): string {
  const count = concerns(verdicts).length;
  const total = verdicts.length;
  return count === 0 ? t("selftests.allOk", { total }) : t("selftests.notOk", { count, total });
}
