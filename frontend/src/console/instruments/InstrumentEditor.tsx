/** The instrument editor: its file on the left, the resulting form on the right. */
import { Button } from "@mantine/core";
import { useDebouncedValue } from "@mantine/hooks";
import { notifications } from "@mantine/notifications";
import { instruments } from "@shared/api/drafts";
import { inLanguage } from "@shared/text";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { keepPreviousData, useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, useEffect, useRef, useState } from "react";
import { useLocation } from "wouter";
import layout from "../editor/Editor.module.css";
import { dropDraft, storeDraft, storedDraft } from "../editor/keptDraft";
import { LeaveGuard } from "../editor/LeaveGuard";
import { showLine, YamlField, type YamlText } from "../editor/YamlField";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { Problems } from "../pages/Problems";
import { Loaded } from "../ui/Loaded";
import { useTitle } from "../ui/page";
import { useSingleSubmit } from "../ui/useSingleSubmit";
import classes from "./Instruments.module.css";
import { TryIt } from "./TryIt";

export function EditInstrumentPage({ name }: { readonly name: string }): JSX.Element {
  const query = useQuery({
    queryKey: ["instruments", name, "to-edit"],
    queryFn: () => instruments.get(name),
    gcTime: 0,
    staleTime: Number.POSITIVE_INFINITY,
  });
  const { language } = useTexts();
  return (
    <Loaded query={query}>
      {(instrument) => (
        <InstrumentEditor
          key={instrument.content_hash}
          id={instrument.key}
          title={inLanguage(instrument.title, language)}
          stored={instrument.yaml}
          begin={withVersion(
            instrument.yaml,
            Math.max(...instrument.versions.map(({ version }) => version)) + 1,
          )}
        />
      )}
    </Loaded>
  );
}

/** The file with the number that its next version has: each number stands for one content. */
export const withVersion = (yaml: string, version: number): string =>
  yaml.replace(/^version:.*$/m, `version: ${version}`);

export function NewInstrumentPage(): JSX.Element {
  const { t } = useTexts();
  return <InstrumentEditor id="new" title={t("instrumentEditor.new")} stored="" begin={EXAMPLE} />;
}

interface InstrumentEditorProps {
  readonly id: string;
  readonly title: string;
  readonly stored: string;
  readonly begin: string;
}

const NO_PROBLEMS = [] as const;

function InstrumentEditor({ id, title, stored, begin }: InstrumentEditorProps): JSX.Element {
  const { t } = useTexts();
  useTitle(t("instrumentEditor.title", { name: title }));
  const [, navigate] = useLocation();
  const queries = useQueryClient();
  const storageKey = `instrument.${id}`;
  const [initial] = useState(() => storedDraft(storageKey) ?? begin);
  const [text, setText] = useState(initial);
  const [settled] = useDebouncedValue(text, 350);
  const field = useRef<YamlText | null>(null);
  const query = useQuery({
    queryKey: ["check-instrument", settled],
    // The text is returned with its preview, so that scores are never requested for another file.
    queryFn: async () => ({ ...(await instruments.check(settled)), text: settled }),
    placeholderData: keepPreviousData,
    staleTime: Number.POSITIVE_INFINITY,
    gcTime: 30_000,
  });
  const unsaved = text !== stored && text !== begin;
  useEffect(() => {
    if (unsaved) storeDraft(storageKey, text);
    else dropDraft(storageKey);
  }, [storageKey, unsaved, text]);
  const upToDate = settled === text && !query.isPlaceholderData;
  const check = query.data;
  const problems = check?.problems ?? NO_PROBLEMS;
  const save = useMutation({
    mutationFn: () => instruments.save(text),
    onSuccess: async (instrument) => {
      dropDraft(storageKey);
      await queries.invalidateQueries({ queryKey: ["instruments"] });
      notifications.show({
        message: t("instrumentEditor.saved", { key: instrument.key }),
        closeButtonProps: { "aria-label": t("action.close") },
      });
      navigate(`/instruments/${instrument.key}`);
    },
  });
  const submit = useSingleSubmit(save);
  const preview = check?.preview ?? null;
  return (
    <div className={layout.editor}>
      <LeaveGuard unsaved={unsaved && !save.isSuccess} />
      <header className={layout.bar}>
        <div className={layout.title}>
          <h1>{title}</h1>
          <p className={layout.status} role="status">
            {!upToDate
              ? t("editor.checking")
              : problems.length > 0
                ? t("editor.problems", { count: problems.length })
                : t(check?.known === true ? "instrumentEditor.known" : "editor.fine")}
          </p>
        </div>
        <div className={layout.actions}>
          <Button
            leftSection={<Icon name="check" size={17} />}
            disabled={!upToDate || check?.ok !== true || check.known}
            loading={save.isPending}
            onClick={() => submit()}
          >
            {t("instrumentEditor.save")}
          </Button>
        </div>
      </header>
      <p className={classes.lead}>
        {t(check?.replaces === true ? "instrumentEditor.replaces" : "instrumentEditor.lead")}
      </p>
      {save.isError && <Failure error={save.error} />}
      {query.isError && <Failure error={query.error} onRetry={() => void query.refetch()} />}
      <div className={layout.halves}>
        <section className={layout.textHalf} aria-label={t("instrumentEditor.text")}>
          <YamlField
            initial={initial}
            label={t("instrumentEditor.text")}
            problems={problems}
            field={field}
            onChange={setText}
          />
          {problems.length > 0 && (
            <div className={layout.problemList}>
              <Problems
                problems={problems}
                onPick={(line) =>
                  field.current !== null && showLine(field.current.view, line, true)
                }
              />
            </div>
          )}
        </section>
        <section className={classes.preview} aria-label={t("instrumentEditor.preview")}>
          {preview === null ? (
            <Notice tone="info" title={t("instrumentEditor.broken")} />
          ) : (
            <TryIt preview={preview} yaml={check?.text ?? ""} />
          )}
        </section>
      </div>
    </div>
  );
}

/** The example with which a new instrument starts: small, complete, and free of others' rights. */
const EXAMPLE = `# An instrument: items, what can be answered, and how answers become scores.
key: my_instrument
version: 1
title:
  en: My questionnaire
  de: Mein Fragebogen
languages: [en, de]

provenance:
  source: Where the wording comes from.
  licence: Under which licence, as far as you know.
  verified: What you compared with the source.

stem:
  en: How much do you agree?
  de: Wie sehr stimmen Sie zu?

scale:
  minimum: 1
  maximum: 5
  labels:
    - {en: not at all, de: gar nicht}
    - {en: completely, de: völlig}

items:
  - key: calm
    type: likert
    text: {en: I felt calm., de: Ich war ruhig.}
  - key: tense
    type: likert
    reverse_keyed: true
    text: {en: I felt tense., de: Ich war angespannt.}

# Before scoring every number x becomes this; leave it out to take answers as they are.
recode: x - 3

scores:
  - key: ease
    label: {en: Ease, de: Gelassenheit}
    formula: (calm - tense) / 2
    minimum: -2
    maximum: 2
`;
