/** One question with its answers: all of them visible, each as large as a thumb. */
import type { JSX } from "react";
import { STEPS_IN_A_ROW } from "./pages";
import classes from "./QuestionField.module.css";
import type { Choosing, NumberField, Option, Question, Rating, TextField } from "./questions";

type Value = string | number | undefined;

interface QuestionFieldProps {
  /** Of this question on the page; other elements have ids that start with it. */
  readonly id: string;
  readonly question: Question;
  readonly value: unknown;
  readonly problem: string | null;
  readonly disabled: boolean;
  readonly onAnswer: (value: Value) => void;
}

/** The attributes with which every kind of field describes itself to a screen reader. */
interface Spoken {
  readonly "aria-labelledby": string;
  readonly "aria-describedby": string | undefined;
  readonly "aria-invalid": boolean;
  readonly "aria-required": boolean;
}

export function QuestionField(props: QuestionFieldProps): JSX.Element {
  const { id, question, problem } = props;
  const hint = question.kind === "number" && question.hint !== "" ? question.hint : null;
  const about = [hint && `${id}-hint`, problem && `${id}-problem`].filter(Boolean).join(" ");
  const spoken: Spoken = {
    "aria-labelledby": `${id}-title`,
    "aria-describedby": about === "" ? undefined : about,
    "aria-invalid": problem !== null,
    "aria-required": question.required,
  };
  return (
    <div
      className={classes.question}
      data-name={question.key}
      data-wrong={problem === null ? undefined : true}
    >
      <div className={classes.title} id={`${id}-title`}>
        {question.title}
      </div>
      {hint !== null && (
        <div className={classes.hint} id={`${id}-hint`}>
          {hint}
        </div>
      )}
      <div className={classes.content}>
        <Field {...props} spoken={spoken} />
      </div>
      {problem !== null && (
        <div className={classes.problem} id={`${id}-problem`} role="alert">
          {problem}
        </div>
      )}
    </div>
  );
}

type FieldProps<Kind extends Question> = Omit<QuestionFieldProps, "id" | "question"> & {
  readonly question: Kind;
  readonly spoken: Spoken;
};

function Field({ question, ...props }: FieldProps<Question>): JSX.Element {
  switch (question.kind) {
    case "rating":
      return <RatingField {...props} question={question} />;
    case "choice":
      return (
        <div role="radiogroup" className={classes.choices} {...props.spoken}>
          <Options {...props} question={question} />
        </div>
      );
    default:
      return <Written {...props} question={question} />;
  }
}

function RatingField(props: FieldProps<Rating>): JSX.Element {
  const { question, spoken } = props;
  const steps = question.options.length;
  return (
    <div className={classes.rating}>
      <div
        role="radiogroup"
        className={classes.scale}
        data-rows={steps > STEPS_IN_A_ROW ? true : undefined}
        data-steps={steps}
        {...spoken}
      >
        {question.ends !== null && <span className={classes.low}>{question.ends[0]}</span>}
        <Options {...props} />
        {question.ends !== null && <span className={classes.high}>{question.ends[1]}</span>}
      </div>
    </div>
  );
}

function Options({
  question,
  value,
  spoken,
  ...props
}: FieldProps<Rating | Choosing>): JSX.Element[] {
  return question.options.map((option) => (
    <OptionField
      key={option.value}
      {...props}
      option={option}
      // The group's unique name distinguishes it from every other group on the page.
      group={spoken["aria-labelledby"]}
      chosen={value === option.value}
      isOptional={!question.required}
    />
  ));
}

interface OptionFieldProps {
  readonly option: Option;
  readonly group: string;
  readonly chosen: boolean;
  readonly isOptional: boolean;
  readonly disabled: boolean;
  readonly onAnswer: (value: Value) => void;
}

function OptionField(props: OptionFieldProps): JSX.Element {
  const { option, chosen, onAnswer } = props;
  return (
    <label className={classes.option}>
      <input
        type="radio"
        className={classes.input}
        name={props.group}
        value={option.value}
        checked={chosen}
        disabled={props.disabled}
        onChange={() => onAnswer(option.value)}
        // A radio button cannot be unchecked by default; where no answer is required, it can here.
        onClick={() => chosen && props.isOptional && onAnswer(undefined)}
      />
      <span>{option.text}</span>
    </label>
  );
}

function Written(props: FieldProps<NumberField | TextField>): JSX.Element {
  const { question, value, disabled, spoken, onAnswer } = props;
  const shared = {
    className: classes.written,
    value: value === undefined || value === null ? "" : String(value),
    disabled,
    ...spoken,
  };
  if (question.kind === "number") {
    return (
      <input
        {...shared}
        type="number"
        inputMode={question.whole ? "numeric" : "decimal"}
        step={question.whole ? 1 : "any"}
        min={question.low ?? undefined}
        max={question.high ?? undefined}
        onChange={(event) => onAnswer(event.currentTarget.value)}
      />
    );
  }
  const most = question.most ?? undefined;
  return question.long ? (
    <textarea
      {...shared}
      rows={4}
      maxLength={most}
      onChange={(event) => onAnswer(event.currentTarget.value)}
    />
  ) : (
    <input
      {...shared}
      type="text"
      maxLength={most}
      onChange={(event) => onAnswer(event.currentTarget.value)}
    />
  );
}
