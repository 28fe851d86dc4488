/** Every measurement of one device, the newest first; none is ever removed. */
import { Button, Group, Modal, Stack, Table, Text, Textarea } from "@mantine/core";
import { type Calibration, calibrations } from "@shared/api/records";
import { number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../../errors";
import { type Key, useTexts } from "../../i18n";
import { calibrationsQuery } from "../../queries";
import classes from "./EquipmentPage.module.css";

const COLUMNS = ["state", "delay", "sd", "n", "date", "method", "by"] as const;

interface HistoryProps {
  readonly name: string;
  readonly own: readonly Calibration[];
  readonly canWrite: boolean;
}

export function History({ name, own, canWrite }: HistoryProps): JSX.Element {
  const { t } = useTexts();
  const [retiring, setRetiring] = useState<Calibration | null>(null);
  return (
    <section className={classes.equipment}>
      <h2>{name}</h2>
      <div className={classes.frame}>
        <Table
          verticalSpacing="sm"
          horizontalSpacing="md"
          aria-label={t("equipment.history", { equipment: name })}
        >
          <Table.Thead>
            <Table.Tr>
              {COLUMNS.map((column) => (
                <Table.Th key={column}>{t(`equipment.${column}`)}</Table.Th>
              ))}
              {canWrite && <Table.Th aria-label={t("equipment.retire")} />}
            </Table.Tr>
          </Table.Thead>
          <Table.Tbody>
            {own.map((one) => (
              <Row key={one.id} one={one} onRetire={canWrite ? setRetiring : null} />
            ))}
          </Table.Tbody>
        </Table>
      </div>
      <Modal
        opened={retiring !== null}
        onClose={() => setRetiring(null)}
        title={t("equipment.retire.title")}
        closeButtonProps={{ "aria-label": t("action.close") }}
      >
        {retiring !== null && <RetireForm one={retiring} onClose={() => setRetiring(null)} />}
      </Modal>
    </section>
  );
}

interface RowProps {
  readonly one: Calibration;
  readonly onRetire: ((one: Calibration) => void) | null;
}

function Row({ one, onRetire }: RowProps): JSX.Element {
  const { t, language } = useTexts();
  const retired = one.retired_at !== null;
  const state: Key = retired
    ? "equipment.retired"
    : one.current
      ? "equipment.current"
      : "equipment.older";
  return (
    <Table.Tr className={one.current ? classes.current : classes.old}>
      <Table.Td>
        <span className={classes.state}>
          {one.current && <Icon name="check" size={16} />}
          {t(state)}
        </span>
        {retired && <div className={classes.note}>{one.retired_reason}</div>}
      </Table.Td>
      <Table.Td className="numbers">{number(one.motion_to_photon_ms, language, 1)} ms</Table.Td>
      <Table.Td className="numbers">{number(one.sd_ms, language, 1)} ms</Table.Td>
      <Table.Td className="numbers">{one.samples}</Table.Td>
      <Table.Td className="numbers">{one.measured_on}</Table.Td>
      <Table.Td>
        {one.method}
        {one.note !== "" && <div className={classes.note}>{one.note}</div>}
      </Table.Td>
      <Table.Td>{one.by.replace("account:", "")}</Table.Td>
      {onRetire !== null && (
        <Table.Td>
          {!retired && (
            <Button size="xs" variant="subtle" color="gray" onClick={() => onRetire(one)}>
              {t("equipment.retire")}
            </Button>
          )}
        </Table.Td>
      )}
    </Table.Tr>
  );
}

interface RetireFormProps {
  readonly one: Calibration;
  readonly onClose: () => void;
}

function RetireForm({ one, onClose }: RetireFormProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [reason, setReason] = useState("");
  const retire = useMutation({
    mutationFn: () => calibrations.retire(one.id, reason.trim()),
    onSuccess: () => {
      void queries.invalidateQueries(calibrationsQuery);
      onClose();
    },
  });
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        if (reason.trim() !== "") retire.mutate();
      }}
    >
      <Stack>
        <Text c="dimmed">{t("equipment.retire.body")}</Text>
        <Textarea
          label={t("equipment.retire.reason")}
          data-autofocus
          autosize
          minRows={2}
          maxLength={2000}
          value={reason}
          onChange={(event) => setReason(event.currentTarget.value)}
        />
        {retire.isError && <Failure error={retire.error} />}
        <Group justify="flex-end">
          <Button variant="default" onClick={onClose}>
            {t("action.cancel")}
          </Button>
          <Button type="submit" disabled={reason.trim() === ""} loading={retire.isPending}>
            {t("equipment.retire")}
          </Button>
        </Group>
      </Stack>
    </form>
  );
}
