/** Add walks: a table of tracks, paths cut from captures, or synthetic walkers. */
import {
  FileInput,
  Modal,
  NumberInput,
  SegmentedControl,
  Select,
  Stack,
  Switch,
  Textarea,
} from "@mantine/core";
import { walking } from "@shared/api/walking";
import { decimalMark } from "@shared/format";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { useTexts } from "../i18n";
import { CapturedWalks } from "./CapturedWalks";
import { NameField, SceneField, WholeNumbers } from "./FormFields";
import { populationsQuery } from "./queries";
import { Send, type SourceProps, useSending } from "./SendWalks";
import classes from "./Walking.module.css";

const SOURCES = ["tracks", "captures", "population"] as const;
type Source = (typeof SOURCES)[number];

const FORMS: Readonly<Record<Source, (props: SourceProps) => JSX.Element>> = {
  tracks: Tracks,
  captures: CapturedWalks,
  population: SyntheticWalks,
};

interface NewWalksProps {
  readonly opened: boolean;
  readonly onClose: () => void;
}

export function NewWalks({ opened, onClose }: NewWalksProps): JSX.Element {
  const { t } = useTexts();
  const [source, setSource] = useState<Source>("tracks");
  const [title, setTitle] = useState("");
  const Form = FORMS[source];
  return (
    <Modal
      opened={opened}
      onClose={onClose}
      title={t("walking.sets.new")}
      size="lg"
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      <Stack>
        <SegmentedControl
          aria-label={t("walking.sets.way")}
          value={source}
          onChange={(value) => setSource(SOURCES.find((one) => one === value) ?? "tracks")}
          data={SOURCES.map((value) => ({ value, label: t(`walking.way.${value}`) }))}
        />
        <p className={classes.soft}>{t(`walking.way.${source}.hint`)}</p>
        <NameField value={title} onChange={setTitle} />
        <Form
          title={title.trim()}
          onDone={() => {
            setTitle("");
            onClose();
          }}
        />
      </Stack>
    </Modal>
  );
}

function Tracks({ title, onDone }: SourceProps): JSX.Element {
  const { t, language } = useTexts();
  const [file, setFile] = useState<File | null>(null);
  const [rateHz, setRate] = useState<number | null>(null);
  const [unit, setUnit] = useState<string | null>(null);
  const [statures, setStatures] = useState("");
  const [synthetic, setSynthetic] = useState(false);
  const sending = useSending(
    () =>
      file === null
        ? Promise.resolve()
        : walking.addTable({
            ...{ file, title, synthetic, rateHz },
            metresPerUnit: unit === null ? null : Number(unit),
            // 1,78 is a number where commas stand before decimals.
            statures: statures
              .split("\n")
              .flatMap((line) => line.trim().replace(/(\d),(\d+)$/, "$1.$2") || []),
          }),
    onDone,
  );
  return (
    <>
      <FileInput
        label={t("walking.table")}
        placeholder={t("walking.table.choose")}
        accept=".csv,.txt,.tsv"
        value={file}
        onChange={setFile}
      />
      <div className={classes.choices}>
        <NumberInput
          label={t("walking.rate")}
          placeholder={t("walking.rate.hint")}
          min={0.1}
          max={10_000}
          decimalSeparator={decimalMark(language)}
          value={rateHz ?? ""}
          onChange={(value) => setRate(typeof value === "number" ? value : null)}
        />
        <Select
          label={t("walking.unit")}
          placeholder={t("walking.unit.header")}
          data={[
            { value: "1", label: "m" },
            { value: "0.01", label: "cm" },
            { value: "0.001", label: "mm" },
          ]}
          value={unit}
          onChange={setUnit}
          clearable
        />
      </div>
      <Textarea
        label={t("walking.statures")}
        description={t("walking.statures.hint")}
        placeholder={"A=1.78\nB=1.65"}
        autosize
        minRows={2}
        maxRows={8}
        value={statures}
        onChange={(event) => setStatures(event.currentTarget.value)}
      />
      <Switch
        label={t("walking.table.synthetic")}
        checked={synthetic}
        onChange={(event) => setSynthetic(event.currentTarget.checked)}
      />
      <Send sending={sending} ready={title !== "" && file !== null} />
    </>
  );
}

function SyntheticWalks({ title, onDone }: SourceProps): JSX.Element {
  const { t } = useTexts();
  const populations = useQuery(populationsQuery);
  const [population, setPopulation] = useState("students");
  const [scene, setScene] = useState<string | null>(null);
  const [counts, setCounts] = useState({ people: 12, repetitions: 2, seed: 1 });
  const sending = useSending(
    () =>
      walking.addWalkSet({ title, origin: { kind: "population", population, scene, ...counts } }),
    onDone,
  );
  const about = populations.data?.find(({ name }) => name === population)?.about;
  return (
    <>
      <Select
        label={t("walking.population")}
        description={about}
        data={(populations.data ?? []).map(({ name }) => name)}
        value={population}
        onChange={(value) => value !== null && setPopulation(value)}
        allowDeselect={false}
      />
      <SceneField
        label={t("walking.scene")}
        placeholder={t("walking.origin.laboratory")}
        value={scene}
        onChange={setScene}
      />
      <WholeNumbers
        fields={COUNTS}
        values={counts}
        onChange={(name, value) => setCounts({ ...counts, [name]: value })}
      />
      <Send sending={sending} ready={title !== ""} />
    </>
  );
}

const COUNTS = [
  { name: "people", min: 2, max: 60 },
  { name: "repetitions", min: 1, max: 10 },
  { name: "seed", min: 0, max: 2 ** 31 - 1 },
] as const;
