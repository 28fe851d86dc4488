/**
 * A form, a page at a time: SurveyJS keeps the answers and their rules, this component draws the
 * frame around it and tells its owner of every change, so that no answer lives only on the screen.
 */
import { Button, Text } from "@mantine/core";
import { type JSX, useEffect, useMemo, useRef, useState } from "react";
import "survey-core/i18n/german";
import { Model } from "survey-core";
import { Survey } from "survey-react-ui";
import type { Administration, Answer } from "../api/types";
import { inLanguage } from "../text";
import { Icon } from "../ui/Icon";
import type { FormDraft } from "./draft";
import classes from "./FormView.module.css";
import { answersOf, type FormWords, surveyJson } from "./surveyJson";
import "./survey.css";

export interface FormTexts extends FormWords {
  readonly back: string;
  readonly next: string;
  readonly submit: string;
  readonly page: (number: number, total: number) => string;
}

interface FormViewProps {
  readonly administration: Administration;
  readonly language: string;
  readonly texts: FormTexts;
  readonly draft: FormDraft;
  readonly startedAt: Date;
  readonly mayOmit?: boolean;
  readonly busy: boolean;
  readonly onChange: (draft: FormDraft) => void;
  readonly onSubmit: (answers: Readonly<Record<string, Answer>>, draft: FormDraft) => void;
}

export function FormView(props: FormViewProps): JSX.Element {
  const { administration, language, texts } = props;
  const { model, draft } = useModel(props);
  const top = useRef<HTMLDivElement>(null);
  const pages = model.visiblePageCount;
  const { instrument } = administration;
  const go = (move: () => boolean) => {
    if (move()) top.current?.scrollIntoView({ block: "start" });
  };
  const submit = () => {
    if (model.validate(true, true))
      props.onSubmit(answersOf(instrument, model.data), draft.current);
  };
  return (
    <div className={classes.form} ref={top}>
      <Head administration={administration} language={language} first={model.currentPageNo === 0} />
      <Survey model={model} />
      <footer className={classes.foot}>
        <Button
          size="lg"
          variant="default"
          leftSection={<Icon name="back" />}
          style={{ visibility: model.isFirstPage ? "hidden" : "visible" }}
          disabled={props.busy}
          onClick={() => go(() => model.prevPage())}
        >
          {texts.back}
        </Button>
        <PageDots page={model.currentPageNo} pages={pages} label={texts.page} />
        {model.isLastPage ? (
          <Button
            size="lg"
            loading={props.busy}
            rightSection={<Icon name="check" />}
            onClick={submit}
          >
            {texts.submit}
          </Button>
        ) : (
          <Button
            size="lg"
            rightSection={<Icon name="forward" />}
            onClick={() => go(() => model.nextPage())}
          >
            {texts.next}
          </Button>
        )}
      </footer>
    </div>
  );
}

interface HeadProps {
  readonly administration: Administration;
  readonly language: string;
  readonly first: boolean;
}

/** The stem stays in sight on every page; the instructions are read once. */
function Head({ administration, language, first }: HeadProps): JSX.Element {
  const { stem, instructions, title } = administration.instrument;
  const lead = inLanguage(stem, language);
  return (
    <div className={classes.head}>
      {first && <Text c="dimmed">{inLanguage(instructions, language)}</Text>}
      <h1 className={classes.stem}>{lead === "" ? inLanguage(title, language) : lead}</h1>
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
          // biome-ignore lint/suspicious/noArrayIndexKey: pages have no other name than their number
          <span key={index} className={index <= page ? classes.passed : classes.ahead} />
        ))}
      </div>
      <span className="numbers" role="status">
        {label(page + 1, pages)}
      </span>
    </div>
  );
}

/** The SurveyJS model of this form in this language; it survives a change of language. */
function useModel(props: FormViewProps) {
  const { administration, language, texts, mayOmit = false, busy } = props;
  const draft = useRef(props.draft);
  const latest = useRef(props);
  const [, redraw] = useState(0);
  useEffect(() => {
    latest.current = props;
  });
  // The words change a moment after the language: a word of theirs tells which one they are in.
  // biome-ignore lint/correctness/useExhaustiveDependencies: texts are new at every drawing
  const model = useMemo(() => {
    const made = new Model(surveyJson(administration, { language, words: texts, mayOmit }));
    made.locale = language;
    made.data = draft.current.data;
    made.currentPageNo = draft.current.page;
    return made;
  }, [administration.key, language, mayOmit, texts.required]);
  useEffect(() => {
    const keep = (changed: Partial<FormDraft>) => {
      draft.current = { ...draft.current, ...changed };
      latest.current.onChange(draft.current);
    };
    const onValue = (_: Model, { name }: { name: string }) => {
      const elapsed = (Date.now() - latest.current.startedAt.getTime()) / 1000;
      const timings = { ...draft.current.timings, [name]: Math.round(elapsed * 10) / 10 };
      keep({ data: { ...model.data }, timings });
    };
    const onPage = () => {
      keep({ page: model.currentPageNo });
      redraw((count) => count + 1);
    };
    model.onValueChanged.add(onValue);
    model.onAfterRenderQuestion.add(tidyLegend);
    model.onCurrentPageChanged.add(onPage);
    return () => {
      model.onAfterRenderQuestion.remove(tidyLegend);
      model.onValueChanged.remove(onValue);
      model.onCurrentPageChanged.remove(onPage);
    };
  }, [model]);
  useEffect(() => {
    model.readOnly = busy;
  }, [model, busy]);
  return { model, draft };
}

/** SurveyJS gives its empty legends a role that a legend may not have. */
function tidyLegend(_: Model, { htmlElement }: { htmlElement: HTMLElement }): void {
  for (const legend of htmlElement.querySelectorAll("legend")) legend.removeAttribute("role");
}
