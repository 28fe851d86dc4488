/** Every text of the study by its key, all languages side by side; and new ones. */
import { Button, TextInput } from "@mantine/core";
import { Icon } from "@shared/ui/Icon";
import { type FormEvent, type JSX, useState } from "react";
import { useTexts } from "../../i18n";
import classes from "../Editor.module.css";
import { useForm, useValue } from "../formContext";
import { isObject } from "../paths";
import { blank } from "../schema";
import { TextsField } from "./Texts";

export function TextsSection(): JSX.Element {
  const { t } = useTexts();
  const { change, languages } = useForm();
  const texts = useValue(["texts"]);
  const [key, setKey] = useState("");
  const keys = isObject(texts) ? Object.keys(texts) : [];
  const add = (event: FormEvent) => {
    event.preventDefault();
    const name = key.trim();
    if (name === "" || keys.includes(name)) return;
    const value = blank({ kind: "texts" }, languages);
    change([{ path: ["texts", name], action: "set", value }]);
    setKey("");
  };
  return (
    <>
      {keys.map((name) => (
        <div key={name} className={classes.entry}>
          <TextsField path={["texts", name]} label={name} />
          <button
            type="button"
            className={classes.drop}
            onClick={() => change([{ path: ["texts", name], action: "remove" }])}
          >
            {t("editor.leaveOut", { name })}
          </button>
        </div>
      ))}
      <form className={classes.inline} onSubmit={add}>
        <TextInput
          label={t("editor.newText")}
          value={key}
          onChange={(event) => setKey(event.currentTarget.value)}
        />
        <Button type="submit" variant="default" leftSection={<Icon name="add" size={16} />}>
          {t("editor.add")}
        </Button>
      </form>
    </>
  );
}
