/** The form for a measurement of a device's own delay. */
import {
  Autocomplete,
  Button,
  Group,
  NumberInput,
  Stack,
  Text,
  Textarea,
  TextInput,
} from "@mantine/core";
import { calibrations } from "@shared/api/records";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { calibrationsQuery } from "../../queries";
import { useSingleSubmit } from "../../ui/useSingleSubmit";

interface AddFormProps {
  readonly existing: readonly string[];
  readonly onClose: () => void;
}

export function AddForm({ existing, onClose }: AddFormProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [equipment, setEquipment] = useState("");
  const [delay, setDelay] = useState<number | string>("");
  const [sd, setSd] = useState<number | string>("");
  const [samples, setSamples] = useState<number | string>("");
  const [method, setMethod] = useState("");
  const [date, setDate] = useState(() => new Date().toISOString().slice(0, 10));
  const [note, setNote] = useState("");
  const add = useMutation({
    mutationFn: () =>
      calibrations.add({
        equipment: equipment.trim(),
        motion_to_photon_ms: Number(delay),
        sd_ms: Number(sd),
        samples: Number(samples),
        method: method.trim(),
        measured_on: date,
        note: note.trim(),
      }),
    onSuccess: () => {
      void queries.invalidateQueries(calibrationsQuery);
      onClose();
    },
  });
  const submit = useSingleSubmit(add);
  const complete =
    [equipment, method, date].every((text) => text.trim() !== "") &&
    [delay, sd, samples].every((value) => typeof value === "number");
  // The unit stands beside the field, so that it is there before anything is typed.
  const inMs = {
    rightSection: (
      <Text size="sm" c="dimmed">
        ms
      </Text>
    ),
    rightSectionPointerEvents: "none",
  } as const;
  const figure = { min: 0, hideControls: true, decimalScale: 3 } as const;
  return (
    <form
      onSubmit={(event) => {
        event.preventDefault();
        if (complete) submit();
      }}
    >
      <Stack>
        <Autocomplete
          label={t("equipment.equipment")}
          description={t("equipment.equipmentHint")}
          data={[...existing]}
          data-autofocus
          maxLength={120}
          value={equipment}
          onChange={setEquipment}
        />
        <Group grow align="end">
          <NumberInput
            {...figure}
            label={t("equipment.delay")}
            {...inMs}
            max={10_000}
            value={delay}
            onChange={setDelay}
          />
          <NumberInput
            {...figure}
            label={t("equipment.sd")}
            {...inMs}
            max={10_000}
            value={sd}
            onChange={setSd}
          />
          <NumberInput
            label={t("equipment.samples")}
            min={1}
            max={1_000_000}
            allowDecimal={false}
            hideControls
            value={samples}
            onChange={setSamples}
          />
        </Group>
        <TextInput
          label={t("equipment.method")}
          description={t("equipment.methodHint")}
          maxLength={400}
          value={method}
          onChange={(event) => setMethod(event.currentTarget.value)}
        />
        <TextInput
          type="date"
          label={t("equipment.date")}
          value={date}
          onChange={(event) => setDate(event.currentTarget.value)}
        />
        <Textarea
          label={t("equipment.note")}
          autosize
          minRows={2}
          maxLength={2000}
          value={note}
          onChange={(event) => setNote(event.currentTarget.value)}
        />
        {add.isError && <Failure error={add.error} />}
        <Group justify="flex-end">
          <Button variant="default" onClick={onClose}>
            {t("action.cancel")}
          </Button>
          <Button type="submit" disabled={!complete} loading={add.isPending}>
            {t("equipment.save")}
          </Button>
        </Group>
      </Stack>
    </form>
  );
}
