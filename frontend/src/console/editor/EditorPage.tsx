/**
 * The page for editing a study: a stored one, or a new one from a template, a study, a file or
 * nothing.
 */
import { Button } from "@mantine/core";
import { drafts } from "@shared/api/drafts";
import { studies } from "@shared/api/endpoints";
import type { StudyDetail } from "@shared/api/types";
import { dateTime } from "@shared/format";
import { inLanguage } from "@shared/text";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useRef, useState } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { templatesQuery } from "../queries";
import { Loaded } from "../ui/Loaded";
import { useTitle } from "../ui/page";
import { Editor } from "./Editor";
import { dropDraft, storedDraft } from "./LeaveGuard";

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
          id={study.key}
          studyKey={study.key}
          title={study.protocol === null ? study.title : inLanguage(study.protocol.title, language)}
          stored={study.yaml ?? ""}
          begin={study.yaml ?? ""}
        />
      )}
    </Loaded>
  );
}

interface NewStudyEditorProps {
  /** "template", "study", "empty" or "draft" (what was imported or kept). */
  readonly from: string;
  readonly name: string | undefined;
}

const EMPTY =
  "# A study is conditions, orders, a procedure, places, colours and texts.\nkey: my-study\n";

export function NewStudyEditor({ from, name = "" }: NewStudyEditorProps): JSX.Element {
  const { t } = useTexts();
  useTitle(t("new.title"));
  const templates = useQuery({ ...templatesQuery, enabled: from === "template" });
  const source = useQuery({
    queryKey: ["studies", name, "to-copy"],
    queryFn: async () => {
      const study = await studies.get(name);
      return drafts.edit(study.yaml ?? "", [
        { path: ["key"], action: "set", value: `${study.key}-copy` },
      ]);
    },
    enabled: from === "study",
    gcTime: 0,
    staleTime: Number.POSITIVE_INFINITY,
  });
  const begin = (text: string) => (
    <EditorWithDraft
      id="new"
      studyKey={null}
      title={t("new.title")}
      stored=""
      begin={text}
      fresh={from !== "draft"}
    />
  );
  if (from === "study") return <Loaded query={source}>{({ yaml }) => begin(yaml)}</Loaded>;
  if (from === "template") {
    return (
      <Loaded query={templates}>
        {(all) => {
          const found = all.find(({ key }) => key === name);
          return found === undefined ? <Failure error={new Error(name)} /> : begin(found.yaml);
        }}
      </Loaded>
    );
  }
  return begin(EMPTY);
}

interface EditorWithDraftProps {
  readonly id: string;
  readonly studyKey: string | null;
  readonly title: string;
  readonly stored: string;
  readonly begin: string;
  /** Called with the text that is about to be stored. */
  readonly onSave?: (text: string) => void;
  /** Whether the starting point was just chosen, so that it replaces a kept draft. */
  readonly fresh?: boolean;
}

/**
 * The editor, starting with the unsaved changes kept from an earlier visit, which can be discarded.
 */
function EditorWithDraft({
  id,
  studyKey,
  title,
  stored,
  begin,
  fresh = false,
  onSave,
}: EditorWithDraftProps): JSX.Element {
  const { t, language } = useTexts();
  const [kept] = useState(() => (fresh ? null : storedDraft(id)));
  const [dropped, setDropped] = useState(false);
  const [openedAt] = useState(() => new Date().toISOString());
  const restored = kept !== null && kept !== stored && !dropped;
  return (
    <Editor
      key={restored ? "kept" : "stored"}
      {...(onSave === undefined ? {} : { onSave })}
      studyKey={studyKey}
      title={title}
      stored={stored}
      initial={restored ? kept : begin}
      notice={
        restored &&
        studyKey !== null && (
          <Notice
            tone="info"
            title={t("editor.restored", { time: dateTime(openedAt, language) })}
            actions={
              <Button
                size="xs"
                variant="default"
                onClick={() => {
                  dropDraft(id);
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
