/**
 * A form, one page at a time. Every change is passed to its owner, so that no answer exists only on
 * the screen.
 */
import { Button, Text } from "@mantine/core";
import { type JSX, type Ref, useEffect, useRef } from "react";
import type { Administration, Answer } from "../api/types";
import { inLanguage } from "../text";
import { Icon } from "../ui/Icon";
import type { FormDraft } from "./draft";
import classes from "./FormView.module.css";
import { QuestionField } from "./QuestionField";
import type { FormTexts } from "./texts";
import { type FilledForm, useFilledForm } from "./useFilledForm";

interface FormViewProps {
  readonly administration: Administration;
  readonly language: string;
  readonly texts: FormTexts;
  readonly draft: FormDraft;
  readonly startedAt: Date;
  readonly canOmit?: boolean;
  readonly busy: boolean;
  readonly onChange: (draft: FormDraft) => void;
  readonly onSubmit: (answers: Readonly<Record<string, Answer>>, draft: FormDraft) => void;
}

export function FormView(props: FormViewProps): JSX.Element {
  const { administration, language, texts } = props;
  const form = useFilledForm(props);
  const top = useRef<HTMLDivElement>(null);
  const heading = useRef<HTMLHeadingElement>(null);
  useEffect(() => {
    if (form.goal === null) return;
    if (form.goal.question === null) {
      top.current?.scrollIntoView({ block: "start" });
      // Move the focus to the heading, so that screen readers and keyboard users start at the top.
      heading.current?.focus({ preventScroll: true });
      return;
    }
    const selector = `[data-name="${form.goal.question}"] :is(input, textarea)`;
    top.current?.querySelector<HTMLElement>(selector)?.focus();
  }, [form.goal]);
  return (
    <div className={classes.form} ref={top}>
      <Head
        heading={heading}
        administration={administration}
        language={language}
        first={form.page === 0}
      />
      <div className={classes.questions}>
        {form.questions.map((question) => (
          <QuestionField
            key={question.key}
            question={question}
            value={form.valueOf(question)}
            problem={form.problemOf(question)}
            disabled={props.busy}
            onAnswer={(value) => form.answer(question, value)}
          />
        ))}
      </div>
      <Foot form={form} texts={texts} busy={props.busy} />
    </div>
  );
}

interface FootProps {
  readonly form: FilledForm;
  readonly texts: FormTexts;
  readonly busy: boolean;
}

function Foot({ form, texts, busy }: FootProps): JSX.Element {
  return (
    <footer className={classes.foot}>
      <Button
        size="lg"
        variant="default"
        leftSection={<Icon name="back" />}
        style={{ visibility: form.page === 0 ? "hidden" : "visible" }}
        disabled={busy}
        onClick={form.back}
      >
        {texts.back}
      </Button>
      <PageDots page={form.page} pages={form.pages} label={texts.page} />
      {form.page >= form.pages - 1 ? (
        <Button size="lg" loading={busy} rightSection={<Icon name="check" />} onClick={form.submit}>
          {texts.submit}
        </Button>
      ) : (
        <Button size="lg" rightSection={<Icon name="forward" />} onClick={form.next}>
          {texts.next}
        </Button>
      )}
    </footer>
  );
}

interface HeadProps {
  readonly heading: Ref<HTMLHeadingElement>;
  readonly administration: Administration;
  readonly language: string;
  readonly first: boolean;
}

/** The stem is shown on every page, the instructions only on the first. */
function Head({ heading, administration, language, first }: HeadProps): JSX.Element {
  const { stem, instructions, title } = administration.instrument;
  const lead = inLanguage(stem, language);
  return (
    <div className={classes.head}>
      {first && <Text c="dimmed">{inLanguage(instructions, language)}</Text>}
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

function PageDots({ page, pages, label }: PageDotsProps): JSX.Element {
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
