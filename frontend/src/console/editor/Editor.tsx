/** The study editor: the form on the left, its YAML on the right, always of the same study. */
import { ActionIcon, Anchor, Button, Tabs, Tooltip } from "@mantine/core";
import { notifications } from "@mantine/notifications";
import { drafts } from "@shared/api/drafts";
import { studies } from "@shared/api/endpoints";
import { ApiError } from "@shared/api/request";
import type { components } from "@shared/api/schema";
import { number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, type ReactNode, useEffect, useMemo, useRef, useState } from "react";
import { useLocation } from "wouter";
import { useHashLocation } from "wouter/use-hash-location";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { Problems } from "../pages/Problems";
import { instrumentsQuery } from "../queries";
import { Changes } from "./DiffView";
import { DryRun } from "./DryRun";
import classes from "./Editor.module.css";
import { Form } from "./Form";
import { FormContext, type FormState } from "./formContext";
import { dropDraft, NEW_STUDY, storeDraft } from "./keptDraft";
import { LeaveGuard } from "./LeaveGuard";
import { isList, type JsonObject } from "./paths";
import { specOfFile } from "./schema";
import { type Draft, useDraft } from "./useDraft";
import { YamlField } from "./YamlField";

interface EditorProps {
  /** The study that gets a new version; null creates a new study. */
  readonly studyKey: string | null;
  readonly title: string;
  /** The newest version when the editing began; 0 for a new study. */
  readonly version: number;
  /** The stored text, with which the editing starts; empty for a new study. */
  readonly stored: string;
  /** The text at which there is nothing to keep: the stored one, or the start of a new study. */
  readonly unchanged: string;
  /** The text at the beginning; another editor is made for another one. */
  readonly initial: string;
  readonly notice?: ReactNode;
  /** Called with the text that is about to be stored. */
  readonly onSave?: (text: string) => void;
}

const TABS = ["write", "dryRun", "changes"] as const;
type Tab = (typeof TABS)[number];

export function Editor(props: EditorProps): JSX.Element {
  const { studyKey, title, version, stored, unchanged, notice, onSave } = props;
  const { t } = useTexts();
  // The field owns the text: after a save it goes on where it is.
  const [initial] = useState(props.initial);
  const draft = useDraft(initial);
  const [tab, setTab] = useState<Tab>("write");
  const id = studyKey ?? NEW_STUDY;
  const unsaved = draft.text !== stored;
  const isChanged = draft.text !== unchanged;
  useEffect(() => {
    if (isChanged) storeDraft(id, draft.text);
    else dropDraft(id);
  }, [id, isChanged, draft.text]);
  const tabs = studyKey === null ? TABS.filter((one) => one !== "changes") : TABS;
  return (
    <div className={classes.editor}>
      <LeaveGuard unsaved={isChanged} />
      <Bar {...{ draft, studyKey, title, version, unsaved, onSave }} />
      {notice}
      <Tabs
        value={tab}
        onChange={(value) => setTab((value ?? "write") as Tab)}
        className={classes.tabs ?? ""}
      >
        <Tabs.List>
          {tabs.map((name) => (
            <Tabs.Tab key={name} value={name}>
              {t(`editor.tab.${name}`)}
            </Tabs.Tab>
          ))}
        </Tabs.List>
        <Tabs.Panel value="write" className={classes.halves ?? ""}>
          <FormHalf draft={draft} />
          <TextHalf draft={draft} initial={initial} />
        </Tabs.Panel>
        <Tabs.Panel value="dryRun" className={classes.page ?? ""}>
          {tab === "dryRun" && <DryRun draft={draft} studyKey={studyKey} />}
        </Tabs.Panel>
        <Tabs.Panel value="changes" className={classes.page ?? ""}>
          {tab === "changes" && studyKey !== null && (
            <Changes draft={draft} studyKey={studyKey} stored={stored} />
          )}
        </Tabs.Panel>
      </Tabs>
    </div>
  );
}

const SAVED = "study-saved";
/** Longer than other notes stay: this one has a link. */
const WITH_LINK_MS = 20_000;

interface SavedNoteProps {
  readonly saved: string;
  /** The editor's address: on another page, also by the link, the note has nothing to say. */
  readonly here: string;
  readonly next: string;
  readonly children: string;
}

function SavedNote({ saved, here, next, children }: SavedNoteProps): JSX.Element {
  const [address] = useHashLocation();
  useEffect(() => {
    if (address !== here) notifications.hide(SAVED);
  }, [address, here]);
  return (
    <>
      {saved} <Anchor href={next}>{children}</Anchor>
    </>
  );
}

interface BarProps {
  readonly draft: Draft;
  readonly studyKey: string | null;
  readonly title: string;
  readonly version: number;
  readonly unsaved: boolean;
  readonly onSave: ((text: string) => void) | undefined;
}

function Bar({ draft, studyKey, title, version, unsaved, onSave }: BarProps): JSX.Element {
  const { t } = useTexts();
  const [, navigate] = useLocation();
  const queries = useQueryClient();
  // Once somebody was told of a newer version, saving again puts this text on top of it.
  const known = useRef(version);
  const save = useMutation({
    mutationFn: () => {
      onSave?.(draft.text);
      return studyKey === null
        ? studies.add(draft.text)
        : studies.addVersion(studyKey, draft.text, known.current);
    },
    onError: (error) => {
      if (error instanceof ApiError && error.code === "stale") {
        known.current = Number(error.valid);
      }
    },
    onSuccess: async (study) => {
      known.current = study.version;
      dropDraft(studyKey ?? NEW_STUDY);
      await queries.invalidateQueries({ queryKey: ["studies"] });
      const saved = t("editor.saved", { version: study.version });
      const here = `/studies/${study.key}/edit`;
      navigate(here);
      notifications.show({
        message:
          studyKey === null ? (
            <SavedNote saved={saved} here={here} next={`#/studies/${study.key}`}>
              {t("editor.saved.next")}
            </SavedNote>
          ) : (
            saved
          ),
        ...(studyKey === null && { id: SAVED, autoClose: WITH_LINK_MS }),
        closeButtonProps: { "aria-label": t("action.close") },
      });
    },
  });
  return (
    <>
      <header className={classes.bar}>
        <div className={classes.title}>
          <h1>{title}</h1>
          <Status draft={draft} unsaved={unsaved} />
        </div>
        <Figures figures={draft.check?.summary ?? null} />
        <div className={classes.actions}>
          <Step label={t("editor.undo")} rotated={false} onClick={draft.undo} />
          <Step label={t("editor.redo")} rotated onClick={draft.redo} />
          <Button
            leftSection={<Icon name="check" size={17} />}
            disabled={!unsaved || !draft.upToDate || draft.check?.ok !== true}
            loading={save.isPending}
            onClick={() => save.mutate()}
          >
            {t(studyKey === null ? "editor.saveNew" : "editor.save")}
          </Button>
        </div>
      </header>
      {save.isError && <Failure error={save.error} />}
    </>
  );
}

interface StepProps {
  readonly label: string;
  readonly rotated: boolean;
  readonly onClick: () => void;
}

function Step({ label, rotated, onClick }: StepProps): JSX.Element {
  return (
    <Tooltip label={label}>
      <ActionIcon variant="default" size="lg" aria-label={label} onClick={onClick}>
        <span className={rotated ? classes.mirrored : undefined}>
          <Icon name="redo" size={17} />
        </span>
      </ActionIcon>
    </Tooltip>
  );
}

function Status({ draft, unsaved }: Pick<BarProps, "draft" | "unsaved">): JSX.Element {
  const { t } = useTexts();
  const count = draft.problems.length;
  return (
    <p className={classes.status} role="status">
      {!draft.upToDate ? (
        t("editor.checking")
      ) : count > 0 ? (
        <span className={classes.bad}>
          <Icon name="alert" size={15} />
          {t("editor.problems", { count })}
        </span>
      ) : (
        <span className={classes.good}>
          <Icon name="check" size={15} />
          {t("editor.fine")}
        </span>
      )}
      <span>{t(unsaved ? "editor.unsaved" : "editor.asStored")}</span>
    </p>
  );
}

const NOBODY: readonly string[] = [];

function FormHalf({ draft }: { readonly draft: Draft }): JSX.Element {
  const { t } = useTexts();
  const schema = useQuery({
    queryKey: ["study-schema"],
    queryFn: drafts.schema,
    staleTime: Number.POSITIVE_INFINITY,
  });
  const library = useQuery(instrumentsQuery);
  const spec = useMemo(
    () => (schema.data === undefined ? null : specOfFile(schema.data)),
    [schema.data],
  );
  const last = useRef<JsonObject | null>(null);
  const readable = draft.check?.tree ?? null;
  if (readable !== null) last.current = readable as JsonObject;
  const tree = last.current;
  if (schema.isError) return <Failure error={schema.error} onRetry={() => void schema.refetch()} />;
  if (spec === null || draft.check === undefined) return <div className={classes.half} />;
  if (tree === null || readable === null) {
    return (
      <div className={classes.half}>
        <Notice tone="warn" title={t("editor.unreadable")}>
          {t("editor.unreadable.body")}
        </Notice>
      </div>
    );
  }
  const state: FormState = {
    tree,
    languages: isList(tree.languages) ? tree.languages.map(String) : NOBODY,
    instruments: library.data?.map(({ key }) => key) ?? NOBODY,
    known: {
      slots: draft.check.summary?.slots ?? null,
      scores: Object.fromEntries(
        (library.data ?? []).map(({ key, scores }) => [key, scores.map((score) => score.key)]),
      ),
    },
    problems: draft.problems,
    change: draft.change,
    reveal: draft.reveal,
  };
  return (
    <section className={classes.half} aria-label={t("editor.form")}>
      {draft.error != null && <Failure error={draft.error} />}
      <FormContext.Provider value={state}>
        <Form spec={spec} />
      </FormContext.Provider>
    </section>
  );
}

function TextHalf({ draft, initial }: { readonly draft: Draft; readonly initial: string }) {
  const { t } = useTexts();
  return (
    <section className={classes.textHalf} aria-label={t("editor.text")}>
      <YamlField
        initial={initial}
        label={t("editor.text")}
        problems={draft.problems}
        field={draft.field}
        onChange={draft.onText}
      />
      {draft.problems.length > 0 && (
        <div className={classes.problemList}>
          <Problems problems={draft.problems} onPick={draft.goTo} />
        </div>
      )}
    </section>
  );
}

interface FiguresProps {
  readonly figures: components["schemas"]["StudyFigures"] | null;
}

/** The figures of a draft, in a line: the size of its design and the length of a session. */
function Figures({ figures }: FiguresProps): JSX.Element {
  const { t, language } = useTexts();
  return (
    <dl className={`${classes.figures} numbers`}>
      {(
        [
          ["figures.conditions", figures?.conditions],
          ["figures.orders", figures?.orders],
          ["figures.slots", figures?.slots],
          ["figures.minutes", figures && Math.round(figures.minutes)],
        ] as const
      ).map(([key, value]) => (
        <div key={key}>
          <dd>
            {key === "figures.minutes" && "≈ "}
            {value == null ? "–" : number(value, language)}
          </dd>
          <dt>{t(key)}</dt>
        </div>
      ))}
    </dl>
  );
}
