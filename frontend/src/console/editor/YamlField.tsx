/** The YAML text field as a React component. */
import { defaultKeymap, history, historyKeymap, isolateHistory } from "@codemirror/commands";
import { yaml } from "@codemirror/lang-yaml";
import {
  bracketMatching,
  HighlightStyle,
  indentUnit,
  syntaxHighlighting,
} from "@codemirror/language";
import { type Diagnostic, lintGutter, lintKeymap, setDiagnostics } from "@codemirror/lint";
import { Compartment, EditorState, type Extension, Transaction } from "@codemirror/state";
import {
  drawSelection,
  EditorView,
  highlightActiveLine,
  highlightActiveLineGutter,
  keymap,
  lineNumbers,
} from "@codemirror/view";
import { tags } from "@lezer/highlight";
import type { Problem } from "@shared/api/request";
import { type JSX, type RefObject, useEffect, useRef } from "react";
import classes from "./Editor.module.css";

interface YamlFieldProps {
  /** The initial text; from then on the field owns it. */
  readonly initial: string;
  readonly label: string;
  readonly problems: readonly Problem[];
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

const colours = HighlightStyle.define([
  { tag: [tags.propertyName, tags.definition(tags.propertyName)], color: "var(--accent)" },
  { tag: [tags.lineComment, tags.comment], color: "var(--ink-soft)", fontStyle: "italic" },
  { tag: [tags.number, tags.bool], color: "var(--sim)" },
  {
    tag: [tags.punctuation, tags.separator, tags.squareBracket, tags.brace],
    color: "var(--ink-soft)",
  },
]);

const theme = EditorView.theme({
  "&": { height: "100%", backgroundColor: "var(--surface)", color: "var(--ink)", fontSize: "13px" },
  "&.cm-focused": { outline: "2px solid var(--accent)", outlineOffset: "-2px" },
  ".cm-scroller": { fontFamily: "var(--mantine-font-family-monospace)", lineHeight: "1.55" },
  ".cm-content": { caretColor: "var(--ink)", padding: "8px 0" },
  ".cm-cursor": { borderLeftColor: "var(--ink)" },
  ".cm-gutters": {
    backgroundColor: "var(--sunken)",
    color: "var(--ink-soft)",
    borderRight: "1px solid var(--line)",
  },
  // As wide as for three digits from the start, or the text would move when they are drawn.
  ".cm-lineNumbers .cm-gutterElement": { minWidth: "3.6em" },
  ".cm-activeLine": { backgroundColor: "color-mix(in srgb, var(--accent) 7%, transparent)" },
  ".cm-activeLineGutter": { backgroundColor: "transparent", color: "var(--ink)" },
  "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground":
    { background: "color-mix(in srgb, var(--accent) 25%, transparent) !important" },
  ".cm-lintRange-error": {
    backgroundImage: "none",
    textDecoration: "underline wavy var(--bad)",
    textUnderlineOffset: "3px",
  },
  ".cm-tooltip": {
    maxWidth: "60ch",
    backgroundColor: "var(--surface)",
    color: "var(--ink)",
    border: "1px solid var(--line-strong)",
    borderRadius: "6px",
  },
  ".cm-diagnostic-error": { borderLeftColor: "var(--bad)" },
});

export interface YamlText {
  readonly view: EditorView;
  readonly setReadable: (label: string, editable: boolean) => void;
}

/**
 * Create the text field for YAML: line numbers, colours, problems at their lines, undo and redo.
 */
function createYamlText(
  parent: HTMLElement,
  doc: string,
  onChange: (text: string, byForm: boolean) => void,
): YamlText {
  const attributes = new Compartment();
  const own = (label: string, editable: boolean): Extension => [
    EditorView.contentAttributes.of({ "aria-label": label, spellcheck: "false", tabindex: "0" }),
    EditorView.editable.of(editable),
    EditorState.readOnly.of(!editable),
  ];
  const view = new EditorView({
    parent,
    state: EditorState.create({
      doc,
      extensions: [
        lineNumbers(),
        lintGutter(),
        highlightActiveLine(),
        highlightActiveLineGutter(),
        drawSelection(),
        history(),
        yaml(),
        indentUnit.of("  "),
        bracketMatching(),
        syntaxHighlighting(colours),
        EditorView.lineWrapping,
        // Tab leaves the field, for keyboard users.
        keymap.of([...defaultKeymap, ...historyKeymap, ...lintKeymap]),
        theme,
        attributes.of(own("", true)),
        EditorView.updateListener.of((update) => {
          if (!update.docChanged) return;
          const byForm = update.transactions.some((one) => one.isUserEvent("form"));
          onChange(update.state.doc.toString(), byForm);
        }),
      ],
    }),
  });
  return {
    view,
    setReadable: (label, editable) =>
      view.dispatch({ effects: attributes.reconfigure(own(label, editable)) }),
  };
}

/** Replace the text by one that differs in one place, as one undoable step. */
export function replaceText(view: EditorView, next: string): void {
  const before = view.state.doc.toString();
  if (before === next) return;
  const { from, to, insert } = stretch(before, next);
  view.dispatch({
    changes: { from, to, insert },
    annotations: [Transaction.userEvent.of("form"), isolateHistory.of("full")],
    effects: EditorView.scrollIntoView(from, { y: "nearest", yMargin: 60 }),
  });
}

/** The one range in which two texts differ. */
function stretch(before: string, after: string) {
  const most = Math.min(before.length, after.length);
  let from = 0;
  while (from < most && before[from] === after[from]) from += 1;
  let tail = 0;
  while (tail < most - from && before.at(-1 - tail) === after.at(-1 - tail)) tail += 1;
  return { from, to: before.length - tail, insert: after.slice(from, after.length - tail) };
}

/** Mark each problem from its position to the end of its line. */
function markProblems(view: EditorView, problems: readonly Problem[]): void {
  const { doc } = view.state;
  const marks: Diagnostic[] = problems
    .filter((problem) => (problem.line ?? 0) >= 1)
    .map((problem) => {
      const line = doc.line(Math.min(problem.line ?? 1, doc.lines));
      const from = Math.min(line.from + Math.max((problem.column ?? 1) - 1, 0), line.to);
      return {
        from,
        to: Math.max(line.to, from),
        severity: "error",
        message: `${problem.path ? `${problem.path}: ` : ""}${problem.message} ${problem.remedy ?? ""}`,
      };
    });
  view.dispatch(setDiagnostics(view.state, marks));
}

/**
 * Move the cursor to a line and scroll it into view; `focus` also moves the keyboard focus there.
 */
export function showLine(view: EditorView, number: number, focus: boolean): void {
  const line = view.state.doc.line(Math.min(Math.max(number, 1), view.state.doc.lines));
  view.dispatch({
    selection: { anchor: line.from },
    effects: EditorView.scrollIntoView(line.from, { y: "center" }),
  });
  if (focus) view.focus();
}
