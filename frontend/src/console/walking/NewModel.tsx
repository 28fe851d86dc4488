/** Start to fit a model: on which walks, in which scene, and with which settings. */
import { Button, Group, Modal, MultiSelect, Select, Stack } from "@mantine/core";
import { type WalkSet, type NewModel as Wish, walking } from "@shared/api/walking";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { useFormSubmit } from "../ui/useSingleSubmit";
import { NameField, SceneField, WholeNumbers } from "./FormFields";
import { numberLabel } from "./furtherNumbers";
import { modelsQuery } from "./queries";
import classes from "./Walking.module.css";

interface NewModelProps {
  readonly opened: boolean;
  readonly sets: readonly WalkSet[];
  readonly onClose: () => void;
}

type Options = Required<NonNullable<Wish["options"]>>;
const USUAL: Options = {
  ...{ steps: 10, k: 100, entries: 5000, reading: "chosen", seed: 1 },
  depends_on: [],
};
const MOST_DEPENDENCIES = 3;
const READINGS = ["chosen", "paper", "time-aware"] as const;
const NUMBERS = [
  { name: "steps", min: 3, max: 12 },
  { name: "k", min: 1, max: 1000 },
  { name: "entries", min: 10, max: 20_000 },
  { name: "seed", min: 0, max: 2 ** 31 - 1 },
] as const;

export function NewModel({ opened, sets, onClose }: NewModelProps): JSX.Element {
  const { t } = useTexts();
  return (
    <Modal
      opened={opened}
      onClose={onClose}
      title={t("walking.model.new")}
      size="lg"
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      <Form sets={sets} onDone={onClose} />
    </Modal>
  );
}

function Form({
  sets,
  onDone,
}: {
  readonly sets: readonly WalkSet[];
  readonly onDone: () => void;
}): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [setId, setSetId] = useState(sets[0]?.id ?? "");
  const [title, setTitle] = useState(sets[0]?.title ?? "");
  const [scene, setScene] = useState<string | null>(null);
  const [options, setOptions] = useState(USUAL);
  const chosen = sets.find(({ id }) => id === setId);
  const isSynthetic = chosen?.origin.kind === "population";
  const order = useMutation({
    mutationFn: () =>
      walking.addModel({ title, walk_set_id: setId, scene: isSynthetic ? null : scene, options }),
    onSuccess: async () => {
      await queries.invalidateQueries({ queryKey: modelsQuery.queryKey });
      onDone();
    },
  });
  const submit = useFormSubmit(order);
  return (
    <form onSubmit={submit}>
      <Stack>
        <Select
          label={t("walking.sets.one")}
          data={sets.map((one) => ({ value: one.id, label: one.title }))}
          value={setId}
          onChange={(value) => {
            if (value === null) return;
            setSetId(value);
            setOptions({ ...options, depends_on: [] });
          }}
          allowDeselect={false}
        />
        <NameField value={title} onChange={setTitle} />
        {!isSynthetic && (
          <SceneField
            label={t("walking.model.scene")}
            description={t("walking.model.scene.hint")}
            placeholder={t("walking.model.scene.open")}
            value={scene}
            onChange={setScene}
          />
        )}
        {chosen !== undefined && (
          <DependsOn
            set={chosen}
            names={options.depends_on}
            onChange={(names) => setOptions({ ...options, depends_on: names })}
          />
        )}
        <details>
          <summary>{t("walking.advanced")}</summary>
          <Stack mt="sm">
            <Select
              label={t("walking.reading")}
              description={t(`walking.reading.${options.reading}.hint`)}
              data={READINGS.map((value) => ({ value, label: t(`walking.reading.${value}`) }))}
              value={options.reading}
              onChange={(value) => {
                const reading = READINGS.find((one) => one === value);
                if (reading !== undefined) setOptions({ ...options, reading });
              }}
              allowDeselect={false}
            />
            <WholeNumbers
              fields={NUMBERS}
              values={options}
              hint={(name) => t(`walking.option.${name}.hint`)}
              onChange={(name, value) => setOptions({ ...options, [name]: value })}
            />
          </Stack>
        </details>
        <div className={classes.dialogButtons}>
          {order.isError && <Failure error={order.error} />}
          <Group justify="flex-end">
            <Button type="submit" loading={order.isPending} disabled={title.trim() === ""}>
              {t("walking.fit")}
            </Button>
          </Group>
        </div>
      </Stack>
    </form>
  );
}

interface DependsOnProps {
  readonly set: WalkSet;
  readonly names: readonly string[];
  readonly onChange: (names: string[]) => void;
}

/** Choose the further numbers on which the model depends; nothing if the walks have none. */
function DependsOn({ set, names, onChange }: DependsOnProps): JSX.Element | null {
  const { t } = useTexts();
  const { numbers, walks, spoilt_numbers: spoilt } = set.summary;
  const known = Object.entries(numbers ?? {});
  if (known.length === 0) return <SpoiltNumbers told={spoilt ?? []} />;
  const data = known.map(([name, one]) => {
    const label = numberLabel(name);
    if (2 * one.walks < walks) {
      const some = t("walking.numbers.some", { some: one.walks, all: walks });
      return { value: name, label: `${label} ${some}`, disabled: true };
    }
    if (one.range.low === one.range.high) {
      return { value: name, label: t("walking.numbers.same", { name: label }), disabled: true };
    }
    return { value: name, label };
  });
  return (
    <>
      <MultiSelect
        label={t("walking.numbers.dependsOn")}
        description={t("walking.numbers.dependsOn.hint")}
        placeholder={names.length === 0 ? t("walking.numbers.dependsOn.none") : ""}
        data={data}
        value={[...names]}
        onChange={onChange}
        maxValues={MOST_DEPENDENCIES}
        clearable
      />
      <SpoiltNumbers told={spoilt ?? []} />
    </>
  );
}

/** The columns of a table that cannot be chosen, because not all of their cells are numbers. */
function SpoiltNumbers({ told }: { readonly told: readonly string[] }): JSX.Element | null {
  const { t } = useTexts();
  if (told.length === 0) return null;
  return (
    <Notice tone="warn" title={t("walking.numbers.notOffered")}>
      {told.map((text) => (
        <p key={text} className={classes.soft}>
          {t("walking.numbers.spoilt", { text })}
        </p>
      ))}
    </Notice>
  );
}
