/**
 * The page for editing a study: a stored one, or a new one from a template, a study, a file or
 * nothing.
 */
import { Button, Title } from "@mantine/core";
import { drafts } from "@shared/api/drafts";
import { studies } from "@shared/api/endpoints";
import type { StudyDetail } from "@shared/api/types";
import { dateTime } from "@shared/format";
import { inLanguage } from "@shared/text";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useRef, useState } from "react";
import { Link } from "wouter";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { templatesQuery } from "../queries";
import { Loaded } from "../ui/Loaded";
import { useTitle } from "../ui/page";
import { Editor } from "./Editor";
import { dropDraft, GIVEN_START, keptDraft, NEW_STUDY, storedDraft } from "./keptDraft";
import { NewDraft } from "./NewDraft";
import classes from "./NewStudy.module.css";

export function EditStudyPage({ studyKey }: { readonly studyKey: string }): JSX.Element {
  const { t, language } = useTexts();
  useTitle(t("editor.title", { name: studyKey }));
  // Always fetched: editing must start from what is stored now.
  const query = useQuery({
    queryKey: ["studies", studyKey, "to-edit"],
    queryFn: () => studies.get(studyKey),
    gcTime: 0,
    staleTime: Number.POSITIVE_INFINITY,
  });
  const mounted = useRef<string | null>(null);
  const saved = useRef<string | null>(null);
  /** What was saved here is in the editor already, which stays with its page and its cursor. */
  const keyOf = ({ content_hash, yaml }: StudyDetail): string => {
    if (mounted.current === null || yaml !== saved.current) mounted.current = content_hash;
    return mounted.current;
  };
  return (
    <Loaded query={query}>
      {(study) => (
        <EditorWithDraft
          key={keyOf(study)}
          onSave={(text) => {
            saved.current = text;
          }}
          studyKey={study.key}
          title={study.protocol === null ? study.title : inLanguage(study.protocol.title, language)}
          version={study.version}
          stored={study.yaml ?? ""}
        />
      )}
    </Loaded>
  );
}

interface NewStudyEditorProps {
  /** "template", "study", "empty", "given" (by another page, or a file) or "draft" (kept). */
  readonly from: string;
  readonly name: string | undefined;
}

const EMPTY =
  "# A study is conditions, orders, a procedure, places, colours and texts.\nkey: my-study\n";

export function NewStudyEditor({ from, name = "" }: NewStudyEditorProps): JSX.Element {
  const { t, language } = useTexts();
  useTitle(t("new.title"));
  const templates = useQuery({ ...templatesQuery, enabled: from === "template" });
  const source = useQuery({
    queryKey: ["studies", name, "to-copy"],
    queryFn: async () => {
      const study = await studies.get(name);
      const copy = await drafts.edit(study.yaml ?? "", [
        { path: ["key"], action: "set", value: `${study.key}-copy` },
      ]);
      return { ...copy, title: study.title };
    },
    enabled: from === "study",
    gcTime: 0,
    staleTime: Number.POSITIVE_INFINITY,
  });
  if (from === "study") {
    return (
      <Loaded query={source}>
        {({ yaml, title }) => <NewStudyFrom text={yaml} name={title} />}
      </Loaded>
    );
  }
  if (from === "template") {
    return (
      <Loaded query={templates}>
        {(all) => {
          const found = all.find(({ key }) => key === name);
          return found === undefined ? (
            <Failure error={new Error(name)} />
          ) : (
            <NewStudyFrom text={found.yaml} name={inLanguage(found.title, language)} />
          );
        }}
      </Loaded>
    );
  }
  if (from === "given") {
    return <NewStudyFrom text={storedDraft(GIVEN_START) ?? EMPTY} name={t("new.draft.given")} />;
  }
  if (from === "draft") {
    return <NewStudy begin={EMPTY} initial={storedDraft(NEW_STUDY) ?? EMPTY} />;
  }
  return <NewStudyFrom text={EMPTY} name={t("new.draft.empty")} />;
}

interface NewStudyFromProps {
  readonly text: string;
  /** What the text is, where a draft has to be discarded before it opens. */
  readonly name: string;
}

/** A new study from a chosen start, once an unsaved draft of another one was dealt with. */
function NewStudyFrom({ text, name }: NewStudyFromProps): JSX.Element {
  const { t } = useTexts();
  const [kept, setKept] = useState(() => keptDraft(NEW_STUDY));
  if (kept === null || kept.text === text) return <NewStudy begin={text} initial={text} />;
  return (
    <div className={classes.choice}>
      <Link href="/new" className={classes.crumbs ?? ""}>
        <Icon name="back" size={16} />
        {t("new.title")}
      </Link>
      <Title order={1}>{name}</Title>
      <NewDraft kept={kept} instead={name} onDiscarded={() => setKept(null)} />
    </div>
  );
}

interface NewStudyProps {
  readonly begin: string;
  readonly initial: string;
}

function NewStudy(props: NewStudyProps): JSX.Element {
  const { t } = useTexts();
  // What is kept changes with every key: the editor begins once.
  const [{ begin, initial }] = useState(props);
  return (
    <Editor
      studyKey={null}
      title={t("new.title")}
      version={0}
      stored=""
      unchanged={begin}
      initial={initial}
    />
  );
}

interface EditorWithDraftProps {
  readonly studyKey: string;
  readonly title: string;
  readonly version: number;
  readonly stored: string;
  /** Called with the text that is about to be stored. */
  readonly onSave: (text: string) => void;
}

/**
 * The editor, starting with the unsaved changes kept from an earlier visit, which can be discarded.
 */
function EditorWithDraft({
  studyKey,
  title,
  version,
  stored,
  onSave,
}: EditorWithDraftProps): JSX.Element {
  const { t, language } = useTexts();
  const [kept] = useState(() => keptDraft(studyKey));
  const [dropped, setDropped] = useState(false);
  const [openedAt] = useState(() => new Date().toISOString());
  const restored = kept !== null && kept.text !== stored && !dropped;
  return (
    <Editor
      key={restored ? "kept" : "stored"}
      onSave={onSave}
      studyKey={studyKey}
      title={title}
      version={version}
      stored={stored}
      unchanged={stored}
      initial={restored ? kept.text : stored}
      notice={
        restored && (
          <Notice
            tone="info"
            title={t("editor.restored", { time: dateTime(kept.changedAt ?? openedAt, language) })}
            actions={
              <Button
                size="xs"
                variant="default"
                onClick={() => {
                  dropDraft(studyKey);
                  setDropped(true);
                }}
              >
                {t("editor.discard")}
              </Button>
            }
          />
        )
      }
    />
  );
}
