/** A text in every language of the study, side by side. */
import { Button, Textarea, TextInput } from "@mantine/core";
import { LANGUAGE_NAMES } from "@shared/i18n/i18n";
import { Icon } from "@shared/ui/Icon";
import { type FormEvent, type JSX, useState } from "react";
import { useTexts } from "../../i18n";
import classes from "../Editor.module.css";
import { useCommitted, useForm, useProblem, useValue } from "../formContext";
import { isObject, type Path } from "../paths";
import { blank } from "../schema";

export function TextsField({
  path,
  label,
}: {
  readonly path: Path;
  readonly label: string;
}): JSX.Element {
  const { languages } = useForm();
  const value = useValue(path);
  const problem = useProblem(path);
  const written = isObject(value) ? Object.keys(value) : [];
  const shown = [...languages, ...written.filter((one) => !languages.includes(one))];
  return (
    <fieldset className={classes.texts}>
      <legend>{label}</legend>
      {problem !== null && <p className={classes.problem}>{problem}</p>}
      <div className={classes.sideBySide}>
        {shown.map((language) => (
          <Wording key={language} path={[...path, language]} language={language} label={label} />
        ))}
      </div>
    </fieldset>
  );
}

interface WordingProps {
  readonly path: Path;
  readonly language: string;
  readonly label: string;
}

function Wording({ path, language, label }: WordingProps): JSX.Element {
  const { change, reveal } = useForm();
  const value = useValue(path);
  const problem = useProblem(path);
  const field = useCommitted(typeof value === "string" ? value : "", (text) =>
    change([{ path, action: "set", value: text }]),
  );
  const name = LANGUAGE_NAMES[language] ?? language;
  return (
    <Textarea
      label={name}
      aria-label={`${label}, ${name}`}
      lang={language}
      autosize
      minRows={1}
      maxRows={18}
      error={problem}
      value={field.value}
      onChange={(event) => field.onChange(event.currentTarget.value)}
      onBlur={field.onBlur}
      onFocus={() => reveal(path)}
    />
  );
}

/** Every text of the study by its key, all languages side by side, with a button to add one. */
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
