import type { TabletState } from "@shared/api/types";
import { administration, instrument, words } from "@shared/forms/example";
import { FormPage } from "@shared/forms/FormPage";
import { type Filling, startFilling } from "@shared/forms/filling";
import { type Question, questionPages } from "@shared/forms/questions";
import { formTexts } from "@shared/forms/texts";
import type { JSX } from "react";
import { renderToStaticMarkup } from "react-dom/server";
import { describe, expect, it } from "vitest";
import { plainTexts } from "../i18n/plain";
import { EarlyScreen } from "./EarlyScreen";
import { markup } from "./markup";

const HOSTILE = `</script><img src=x onerror=alert(1)> & "quoted" 'too'`;
const state = { language: "en", simulated: true } as TabletState;
const texts = formTexts(plainTexts("en"));
const pagesOf = (of = administration) =>
  questionPages(of, { language: "en", words, canOmit: false });

const isLong = (question: Question): boolean => question.kind === "text" && question.long;

/** Without the order of attributes, which means nothing. */
const sorted = (html: string): string =>
  html.replace(/<(\w+)((?: [\w:-]+="[^"]*")+)/g, (_, tag: string, rest: string) =>
    [`<${tag}`, ...[...rest.matchAll(/ [\w:-]+="[^"]*"/g)].map(String).sort()].join(""),
  );

function expectSame(element: JSX.Element): void {
  const drawn = markup(element);
  expect(drawn).not.toBe("");
  expect(sorted(drawn)).toBe(sorted(renderToStaticMarkup(element).replaceAll("/>", ">")));
}

const screen = (filling: Filling, of = administration) => (
  <EarlyScreen
    state={state}
    administration={of}
    pages={pagesOf(of)}
    filling={filling}
    texts={texts}
    simulated="Simulated"
  />
);

describe("a form drawn without React", () => {
  it("is what React draws, on every page without long texts", () => {
    for (const [page, questions] of pagesOf().entries()) {
      if (questions.some(isLong)) continue;
      const draft = { data: {}, page, timings: {}, traces: {} };
      expectSame(screen(startFilling(draft, 0)));
    }
  });

  it("has what was chosen, typed or wrong, in every kind of question", () => {
    const kinds = new Set<string>();
    for (const all of pagesOf()) {
      const questions = all.filter((one) => !isLong(one));
      for (const { kind } of questions) kinds.add(kind);
      expectSame(
        <FormPage
          id="x"
          administration={administration}
          language="en"
          questions={questions}
          isFirst={false}
          disabled={true}
          valueOf={(question) => ("options" in question ? question.options[0]?.value : HOSTILE)}
          problemOf={() => HOSTILE}
          onAnswer={() => {}}
        >
          {null}
        </FormPage>,
      );
    }
    expect([...kinds].sort()).toEqual(["choice", "number", "rating", "text"]);
  });

  it("shows the texts of a study as they are, whatever they contain", () => {
    const named = { ...instrument, stem: { en: HOSTILE }, instructions: { en: HOSTILE } };
    const draft = { data: {}, page: 0, timings: {}, traces: {} };
    const element = screen(startFilling(draft, 0), { ...administration, instrument: named });
    expectSame(element);
    expect(markup(element)).not.toContain("<img");
  });

  it("refuses what it cannot draw", () => {
    expect(() => markup(<p style={{ color: "red" }} />)).toThrow("style");
    expect(() => markup(<textarea defaultValue="x" />)).toThrow("textarea");
    expect(() => markup(<p contentEditable={true} />)).toThrow("contentEditable");
  });
});
