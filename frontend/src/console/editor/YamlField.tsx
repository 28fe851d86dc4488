/** The YAML of a file as a React component around the text field. */
import type { ConfigProblem } from "@shared/api/types";
import { type JSX, type RefObject, useEffect, useRef } from "react";
import classes from "./Editor.module.css";
import { createYamlText, markProblems, type YamlText } from "./yamlText";

interface YamlFieldProps {
  /** The text at the beginning; from then on the field holds it. */
  readonly initial: string;
  readonly label: string;
  readonly problems: readonly ConfigProblem[];
  readonly field: RefObject<YamlText | null>;
  readonly onChange: (text: string, byForm: boolean) => void;
}

export function YamlField(props: YamlFieldProps): JSX.Element {
  const { initial, label, problems, field } = props;
  const parent = useRef<HTMLDivElement>(null);
  const latest = useRef(props);
  useEffect(() => {
    latest.current = props;
  });
  useEffect(() => {
    if (parent.current === null) return;
    const made = createYamlText(parent.current, initial, (text, byForm) =>
      latest.current.onChange(text, byForm),
    );
    field.current = made;
    return () => {
      made.view.destroy();
      field.current = null;
    };
  }, [initial, field]);
  useEffect(() => {
    field.current?.setReadable(label, true);
  }, [label, field]);
  useEffect(() => {
    if (field.current !== null) markProblems(field.current.view, problems);
  }, [problems, field]);
  return <div className={classes.yaml} ref={parent} />;
}
