/**
 * What a page of a form looks like, without any state of its own.
 *
 * React draws it, and the tablet draws its first page with it before React is there: see
 * `tablet/early`. So nothing in it may use a hook, or a component that does.
 */
import type { JSX, ReactNode, Ref } from "react";
import type { Administration } from "../api/types";
import { inLanguage } from "../text";
import classes from "./FormPage.module.css";
import { QuestionField } from "./QuestionField";
import type { Question } from "./questions";

interface FormPageProps {
  /** Of this form on the page; other elements have ids that start with it. */
  readonly id: string;
  readonly top?: Ref<HTMLDivElement>;
  readonly heading?: Ref<HTMLHeadingElement>;
  readonly administration: Administration;
  readonly language: string;
  readonly questions: readonly Question[];
  readonly isFirst: boolean;
  readonly disabled: boolean;
  readonly valueOf: (question: Question) => unknown;
  readonly problemOf: (question: Question) => string | null;
  readonly onAnswer: (question: Question, value: string | number | undefined) => void;
  /** The foot. */
  readonly children: ReactNode;
}

export function FormPage(props: FormPageProps): JSX.Element {
  return (
    <div className={classes.form} ref={props.top}>
      <Head
        heading={props.heading}
        administration={props.administration}
        language={props.language}
        isFirst={props.isFirst}
      />
      <div className={classes.questions}>
        {props.questions.map((question) => (
          <QuestionField
            key={question.key}
            id={`${props.id}-${question.key}`}
            question={question}
            value={props.valueOf(question)}
            problem={props.problemOf(question)}
            disabled={props.disabled}
            onAnswer={(value) => props.onAnswer(question, value)}
          />
        ))}
      </div>
      <footer className={classes.foot}>{props.children}</footer>
    </div>
  );
}

interface HeadProps {
  readonly heading: Ref<HTMLHeadingElement> | undefined;
  readonly administration: Administration;
  readonly language: string;
  readonly isFirst: boolean;
}

/** The stem is shown on every page, the instructions only on the first. */
function Head({ heading, administration, language, isFirst }: HeadProps): JSX.Element {
  const { stem, instructions, title } = administration.instrument;
  const lead = inLanguage(stem, language);
  return (
    <div className={classes.head}>
      {isFirst && <p className={classes.instructions}>{inLanguage(instructions, language)}</p>}
      <h1 className={classes.stem} ref={heading} tabIndex={-1}>
        {lead === "" ? inLanguage(title, language) : lead}
      </h1>
    </div>
  );
}

interface PageDotsProps {
  readonly page: number;
  readonly pages: number;
  readonly label: (number: number, total: number) => string;
}

export function PageDots({ page, pages, label }: PageDotsProps): JSX.Element {
  return (
    <div className={classes.progress}>
      <div className={classes.dots} aria-hidden="true">
        {Array.from({ length: pages }, (_, index) => (
          // biome-ignore lint/suspicious/noArrayIndexKey: pages have no identifier other than their number
          <span key={index} className={index <= page ? classes.passed : classes.next} />
        ))}
      </div>
      <span className="numbers" role="status">
        {label(page + 1, pages)}
      </span>
    </div>
  );
}
