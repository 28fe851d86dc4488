/** A wording in every language of the study, side by side. */
import { Textarea } from "@mantine/core";
import { LANGUAGE_NAMES } from "@shared/i18n/i18n";
import type { JSX } from "react";
import classes from "../Editor.module.css";
import { useForm, useProblem, useValue } from "../formContext";
import type { Path } from "../paths";
import { isObject } from "../paths";
import { useCommitted } from "../useCommitted";

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
