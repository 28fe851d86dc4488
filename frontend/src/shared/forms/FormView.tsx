/**
 * A form, one page at a time. Every change is passed to its owner, so that no answer exists only on
 * the screen.
 */
import { Button } from "@mantine/core";
import { type JSX, useEffect, useId, useRef } from "react";
import type { Administration, Answer } from "../api/types";
import { Icon } from "../ui/Icon";
import type { FormDraft } from "./draft";
import { FormPage, PageDots } from "./FormPage";
import type { Filling } from "./filling";
import type { FormTexts } from "./texts";
import { type FilledForm, useFilledForm } from "./useFilledForm";

interface FormViewProps {
  readonly administration: Administration;
  readonly language: string;
  readonly texts: FormTexts;
  readonly draft: FormDraft;
  /** How far the form was filled in before this view was there; otherwise it begins with `draft`. */
  readonly begun?: Filling | undefined;
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
    <FormPage
      id={useId()}
      top={top}
      heading={heading}
      administration={administration}
      language={language}
      questions={form.questions}
      isFirst={form.page === 0}
      disabled={props.busy}
      valueOf={form.valueOf}
      problemOf={form.problemOf}
      onAnswer={form.answer}
    >
      <Foot form={form} texts={texts} busy={props.busy} />
    </FormPage>
  );
}

interface FootProps {
  readonly form: FilledForm;
  readonly texts: FormTexts;
  readonly busy: boolean;
}

function Foot({ form, texts, busy }: FootProps): JSX.Element {
  return (
    <>
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
    </>
  );
}
