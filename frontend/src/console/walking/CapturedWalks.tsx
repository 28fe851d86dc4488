/** Cuts walks from stored captures: which ones, and who walks in each. */
import { MultiSelect, NumberInput, TextInput } from "@mantine/core";
import { walking } from "@shared/api/walking";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { capturesQuery } from "../captures/queries";
import { useTexts } from "../i18n";
import { Send, useSending, type WayProps } from "./NewWalks";
import classes from "./Walking.module.css";

interface Person {
  readonly subject: string;
  readonly stature: number | null;
}

const NOBODY: Person = { subject: "", stature: null };

export function CapturedWalks({ title, onDone }: WayProps): JSX.Element {
  const { t } = useTexts();
  const captures = useQuery(capturesQuery).data?.captures ?? [];
  const [chosen, setChosen] = useState<readonly string[]>([]);
  const [people, setPeople] = useState<Readonly<Record<string, Person>>>({});
  const personOf = (id: string): Person => people[id] ?? NOBODY;
  const set = (id: string, person: Person) => setPeople({ ...people, [id]: person });
  const sending = useSending(
    () =>
      walking.addWalkSet({
        title,
        origin: {
          kind: "captures",
          captures: chosen.map((id) => ({
            capture_id: id,
            subject: personOf(id).subject.trim(),
            stature_m: personOf(id).stature,
          })),
        },
      }),
    onDone,
  );
  const named = chosen.every((id) => personOf(id).subject.trim() !== "");
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
      {chosen.map((id) => {
        const name = captures.find((one) => one.id === id)?.title ?? id;
        return (
          <div key={id} className={classes.choices}>
            <TextInput
              label={t("walking.subject.of", { name })}
              required
              maxLength={80}
              value={personOf(id).subject}
              onChange={(event) => set(id, { ...personOf(id), subject: event.currentTarget.value })}
            />
            <NumberInput
              label={t("walking.stature")}
              min={0.5}
              max={2.6}
              step={0.01}
              decimalScale={2}
              value={personOf(id).stature ?? ""}
              onChange={(value) =>
                set(id, { ...personOf(id), stature: typeof value === "number" ? value : null })
              }
            />
          </div>
        );
      })}
      <Send sending={sending} ready={title !== "" && chosen.length > 0 && named} />
    </>
  );
}
