/** Cut walks from stored captures: which ones, who walks in each, where, and with what. */
import { MultiSelect, NumberInput, TagsInput, TextInput } from "@mantine/core";
import { walking } from "@shared/api/walking";
import { decimalMark } from "@shared/format";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { capturesQuery } from "../captures/queries";
import { useTexts } from "../i18n";
import { SceneField } from "./FormFields";
import { isNumberName, numberLabel } from "./furtherNumbers";
import { Send, type SourceProps, useSending } from "./SendWalks";
import classes from "./Walking.module.css";

const MOST_NUMBERS = 10;

interface Recording {
  readonly subject: string;
  readonly stature: number | null;
  readonly scene: string | null;
  readonly numbers: Readonly<Record<string, number>>;
}

const UNKNOWN: Recording = { subject: "", stature: null, scene: null, numbers: {} };

export function CapturedWalks({ title, onDone }: SourceProps): JSX.Element {
  const { t } = useTexts();
  const captures = useQuery(capturesQuery).data?.captures ?? [];
  const [chosen, setChosen] = useState<readonly string[]>([]);
  const [recordings, setRecordings] = useState<Readonly<Record<string, Recording>>>({});
  const [names, setNames] = useState<readonly string[]>([]);
  const recordingOf = (id: string): Recording => recordings[id] ?? UNKNOWN;
  const sending = useSending(
    () =>
      walking.addWalkSet({
        title,
        origin: {
          kind: "captures",
          captures: chosen.map((id) => ({
            capture_id: id,
            subject: recordingOf(id).subject.trim(),
            stature_m: recordingOf(id).stature,
            scene: recordingOf(id).scene,
            numbers: Object.fromEntries(
              Object.entries(recordingOf(id).numbers).filter(([name]) => names.includes(name)),
            ),
          })),
        },
      }),
    onDone,
  );
  const wrong = names.find((name) => !isNumberName(name));
  const named = chosen.every((id) => recordingOf(id).subject.trim() !== "");
  return (
    <>
      <MultiSelect
        label={t("walking.captures")}
        placeholder={t(captures.length === 0 ? "walking.captures.none" : "walking.captures.choose")}
        data={captures.map((one) => ({ value: one.id, label: one.title }))}
        value={[...chosen]}
        onChange={setChosen}
        searchable
        maxValues={200}
      />
      <TagsInput
        label={t("walking.numbers.names")}
        description={t("walking.numbers.names.hint")}
        placeholder={names.length === 0 ? "load_kg" : ""}
        value={[...names]}
        onChange={setNames}
        maxTags={MOST_NUMBERS}
        error={wrong === undefined ? null : t("walking.numbers.wrong", { name: wrong })}
      />
      {chosen.map((id) => (
        <RecordingFields
          key={id}
          name={captures.find((one) => one.id === id)?.title ?? id}
          names={names.filter(isNumberName)}
          recording={recordingOf(id)}
          onChange={(recording) => setRecordings({ ...recordings, [id]: recording })}
        />
      ))}
      <Send
        sending={sending}
        ready={title !== "" && chosen.length > 0 && named && wrong === undefined}
      />
    </>
  );
}

interface RecordingFieldsProps {
  readonly name: string;
  readonly names: readonly string[];
  readonly recording: Recording;
  readonly onChange: (recording: Recording) => void;
}

function RecordingFields(props: RecordingFieldsProps): JSX.Element {
  const { name, names, recording, onChange } = props;
  const { t, language } = useTexts();
  const setNumber = (which: string, value: number | string) => {
    const { [which]: _, ...others } = recording.numbers;
    const numbers = typeof value === "number" ? { ...others, [which]: value } : others;
    onChange({ ...recording, numbers });
  };
  return (
    <fieldset className={classes.recording}>
      <legend>{name}</legend>
      <div className={classes.choices}>
        <TextInput
          label={t("walking.subject")}
          required
          maxLength={80}
          value={recording.subject}
          onChange={(event) => onChange({ ...recording, subject: event.currentTarget.value })}
        />
        <NumberInput
          label={t("walking.stature")}
          min={0.5}
          max={2.6}
          step={0.01}
          decimalScale={2}
          decimalSeparator={decimalMark(language)}
          value={recording.stature ?? ""}
          onChange={(value) =>
            onChange({ ...recording, stature: typeof value === "number" ? value : null })
          }
        />
        <SceneField
          label={t("walking.scene")}
          placeholder={t("walking.scene.ofModel")}
          withOpenFloor
          value={recording.scene}
          onChange={(scene) => onChange({ ...recording, scene })}
        />
        {names.map((which) => (
          <NumberInput
            key={which}
            label={numberLabel(which)}
            placeholder={t("walking.numbers.unknown")}
            decimalSeparator={decimalMark(language)}
            value={recording.numbers[which] ?? ""}
            onChange={(value) => setNumber(which, value)}
          />
        ))}
      </div>
    </fieldset>
  );
}
