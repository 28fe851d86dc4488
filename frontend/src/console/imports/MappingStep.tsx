/** The mapping of the columns, next to a preview of the result that is updated at every change. */
import { Button, Group } from "@mantine/core";
import { type ImportMapping, type ImportPreview, imports } from "@shared/api/imports";
import type { StudyDetail } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../errors";
import { type Key, useTexts } from "../i18n";
import { checkQuery, instrumentQuery } from "../queries";
import { useSingleSubmit } from "../ui/useSingleSubmit";
import { CheckPanel } from "./CheckPanel";
import { ColumnFields } from "./ColumnFields";
import classes from "./Imports.module.css";
import { ItemColumns } from "./ItemColumns";
import { OfferPanel } from "./OfferPanel";
import type { OpenedFile } from "./readText";
import { WordFields } from "./WordFields";

interface StepProps {
  readonly study: StudyDetail;
  readonly file: OpenedFile;
  readonly preview: ImportPreview;
  readonly onPreview: (instrument: string, headerRows: number | null) => void;
  readonly onDone: (id: string) => void;
}

export function MappingStep({ study, file, preview, onPreview, onDone }: StepProps): JSX.Element {
  const { t } = useTexts();
  const [mapping, setMapping] = useState<ImportMapping>(preview.proposal ?? emptyMapping(preview));
  const change = (part: Partial<ImportMapping>): void => setMapping({ ...mapping, ...part });
  const ready = mapping.participant !== "" && mapping.sets.some(hasItems);
  const requested = { ...mapping, sets: mapping.sets.filter(hasItems) };
  const check = useQuery({
    ...checkQuery(study.key, `${file.name} ${file.text.length}`, file.text, requested),
    enabled: ready,
  });
  const items = useQuery(instrumentQuery(preview.instrument));
  const words = [...new Set([...preview.words, ...(check.data?.unknown_words ?? [])])];
  return (
    <>
      <FilePreview look={preview} />
      {preview.remembered && (
        <Notice tone="info" title={t("imports.remembered")}>
          {t("imports.remembered.body")}
        </Notice>
      )}
      {preview.proposal === null && (
        <Notice tone="warn" title={t("imports.unknown")}>
          {t("imports.unknown.body")}
        </Notice>
      )}
      {(preview.offer !== null || preview.left_out.length > 0) && (
        <OfferPanel study={study} preview={preview} onPreview={onPreview} />
      )}
      <ColumnFields preview={preview} mapping={mapping} onChange={change} onPreview={onPreview} />
      {items.data !== undefined && (
        <ItemColumns
          preview={preview}
          items={items.data.preview.instrument.items}
          reversed={check.data?.reversed_items ?? []}
          mapping={mapping}
          onChange={change}
        />
      )}
      <WordFields
        study={study}
        words={words}
        conditions={conditionWords(preview, mapping, check.data?.conditions)}
        mapping={mapping}
        onChange={change}
      />
      {check.isError && <Failure error={check.error} />}
      {ready && check.data !== undefined && <CheckPanel check={check.data} onShift={change} />}
      <Store
        study={study}
        file={file}
        mapping={requested}
        allowed={ready && check.data?.n_problems === 0 && check.data.forms > 0 && !check.isFetching}
        forms={check.data?.forms ?? 0}
        onDone={onDone}
      />
    </>
  );
}

interface StoreProps extends Pick<StepProps, "study" | "file" | "onDone"> {
  readonly mapping: ImportMapping;
  readonly allowed: boolean;
  readonly forms: number;
}

function Store({ study, file, mapping, allowed, forms, onDone }: StoreProps): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const store = useMutation({
    mutationFn: () => imports.takeIn(study.key, file.name, file.text, mapping),
    onSuccess: async ({ id }) => {
      await queries.invalidateQueries({ queryKey: ["studies", study.key, "imports"] });
      onDone(id);
    },
  });
  const submit = useSingleSubmit(store);
  return (
    <>
      {store.isError && <Failure error={store.error} />}
      <Group justify="flex-end" className={classes.foot ?? ""}>
        <span className={classes.soft}>{t("imports.whole")}</span>
        <Button
          leftSection={<Icon name="check" size={18} />}
          disabled={!allowed}
          loading={store.isPending}
          onClick={() => submit()}
        >
          {t("imports.do", { count: forms })}
        </Button>
      </Group>
    </>
  );
}

const hasItems = (one: ImportMapping["sets"][number]): boolean => Object.keys(one.items).length > 0;

function emptyMapping(preview: ImportPreview): ImportMapping {
  return {
    instrument: preview.instrument,
    participant: "",
    condition: null,
    date: null,
    date_order: "iso",
    sets: [{ items: {}, condition: null }],
    conditions: {},
    words: {},
    multiply: 1,
    add: 0,
    turned: [],
    header_rows: preview.header_rows,
  };
}

/** The names of the conditions in the file, from the column that is selected now. */
function conditionWords(
  look: ImportPreview,
  mapping: ImportMapping,
  found: readonly { readonly condition: string; readonly in_study: boolean }[] | undefined,
): readonly string[] {
  const assigned = mapping.sets.flatMap(({ condition }) => condition ?? []);
  const same = mapping.condition !== null && mapping.condition === look.proposal?.condition;
  const own = same ? look.condition_words : assigned;
  const unknown = (found ?? [])
    .filter(({ in_study }) => !in_study)
    .map(({ condition }) => condition);
  return [...new Set([...own, ...Object.keys(mapping.conditions), ...unknown])].filter(
    (word) => word !== "",
  );
}

const SEPARATORS: Readonly<Record<string, Key>> = {
  ",": "imports.separator.comma",
  ";": "imports.separator.semicolon",
  "\t": "imports.separator.tab",
};

/** The first rows of a file as they were read. */
function FilePreview({ look }: { readonly look: ImportPreview }): JSX.Element {
  const { t } = useTexts();
  const separator = t(SEPARATORS[look.separator] ?? "imports.separator.comma");
  return (
    <details open={look.columns.length <= 12}>
      <summary className={classes.summary}>
        {t("imports.read", { rows: look.rows, columns: look.columns.length, separator })}
      </summary>
      {/* biome-ignore lint/a11y/noNoninteractiveTabindex: scrollable content must be reachable with
         the keyboard */}
      <section className={classes.scroll} aria-label={t("imports.firstRows")} tabIndex={0}>
        <table className={`${classes.grid} numbers`}>
          <thead>
            <tr>
              {look.columns.map(({ name, label }) => (
                <th key={name} scope="col" title={label}>
                  {name}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {look.first_rows.map((row, line) => (
              // biome-ignore lint/suspicious/noArrayIndexKey: rows of a file have no other identifier
              <tr key={line}>
                {row.map((cell, at) => (
                  <td key={look.columns[at]?.name}>{cell}</td>
                ))}
              </tr>
            ))}
          </tbody>
        </table>
      </section>
    </details>
  );
}
