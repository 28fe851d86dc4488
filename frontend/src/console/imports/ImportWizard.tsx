/** The steps from a file to stored answers: choose it, map its columns, check the preview. */
import { Button, FileButton, Modal } from "@mantine/core";
import { type AnswerImport, type ImportPreview, imports } from "@shared/api/imports";
import { bytesOf } from "@shared/api/request";
import type { StudyDetail } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useMutation } from "@tanstack/react-query";
import { type DragEvent, type JSX, useState } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import classes from "./Imports.module.css";
import { MappingStep } from "./MappingStep";
import { decoded, isText, type OpenedFile } from "./readText";

interface WizardProps {
  readonly study: StudyDetail;
  readonly opened: boolean;
  readonly onClose: () => void;
  /** Show an existing import. */
  readonly onOpen: (id: string) => void;
}

export function ImportWizard({ study, opened, onClose, onOpen }: WizardProps): JSX.Element {
  const { t } = useTexts();
  return (
    <Modal
      opened={opened}
      onClose={onClose}
      size="78rem"
      title={t("imports.open")}
      closeOnClickOutside={false}
      classNames={{ content: classes.dialog ?? "" }}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      <Wizard study={study} onOpen={onOpen} />
    </Modal>
  );
}

function Wizard({ study, onOpen }: Pick<WizardProps, "study" | "onOpen">): JSX.Element {
  const { t } = useTexts();
  const [file, setFile] = useState<OpenedFile | null>(null);
  const previewing = useMutation({
    mutationFn: async (wish: {
      file: OpenedFile;
      instrument: string | null;
      heads: number | null;
    }) => imports.preview(study.key, wish.file.text, wish.instrument, wish.heads),
  });
  const [stranger, setStranger] = useState<string | null>(null);
  const [unread, setUnread] = useState<unknown>(null);
  const choose = async (chosen: File | null): Promise<void> => {
    if (chosen === null) return;
    const content = await bytesOf(chosen).catch((error: unknown) => {
      setUnread(error);
      return null;
    });
    if (content === null) return;
    setUnread(null);
    const opened = { name: chosen.name.slice(-200), text: decoded(content) };
    const text = isText(opened.text);
    setStranger(text ? null : chosen.name);
    setFile(text ? opened : null);
    previewing.reset();
    if (text) previewing.mutate({ file: opened, instrument: null, heads: null });
  };
  const preview = (instrument: string, heads: number | null): void => {
    if (file !== null) previewing.mutate({ file, instrument, heads });
  };
  return (
    <div className={classes.wizard}>
      <Choose fileName={file?.name ?? null} onFile={choose} />
      {stranger !== null && (
        <Notice tone="bad" title={t("imports.noTable", { name: stranger })}>
          {t("imports.noTable.body")}
        </Notice>
      )}
      {unread !== null && <Failure error={unread} />}
      {previewing.isError && <Failure error={previewing.error} />}
      {file !== null && previewing.data !== undefined && (
        <PreviewedImport
          study={study}
          file={file}
          preview={previewing.data}
          onPreview={preview}
          onOpen={onOpen}
        />
      )}
    </div>
  );
}

interface PreviewedImportProps extends Pick<WizardProps, "study" | "onOpen"> {
  readonly file: OpenedFile;
  readonly preview: ImportPreview;
  readonly onPreview: (instrument: string, headerRows: number | null) => void;
}

function PreviewedImport({
  study,
  file,
  preview,
  onPreview,
  onOpen,
}: PreviewedImportProps): JSX.Element {
  return (
    <>
      {preview.same_file !== null && <DuplicateNotice found={preview.same_file} onOpen={onOpen} />}
      <MappingStep
        // Start over with another file, instrument or number of header rows.
        key={`${file.name} ${preview.instrument} ${preview.header_rows} ${file.text.length}`}
        study={study}
        file={file}
        preview={preview}
        onPreview={onPreview}
        onDone={onOpen}
      />
    </>
  );
}

function DuplicateNotice({
  found,
  onOpen,
}: {
  readonly found: AnswerImport;
  readonly onOpen: (id: string) => void;
}): JSX.Element {
  const { t } = useTexts();
  return (
    <Notice
      tone="warn"
      title={t("imports.same")}
      actions={
        <Button size="xs" variant="default" onClick={() => onOpen(found.id)}>
          {t("imports.same.open")}
        </Button>
      }
    >
      {t("imports.same.body", { file: found.file_name })}
    </Notice>
  );
}

interface ChooseProps {
  readonly fileName: string | null;
  readonly onFile: (file: File | null) => Promise<void>;
}

function Choose({ fileName, onFile }: ChooseProps): JSX.Element {
  const { t } = useTexts();
  const drop = (event: DragEvent): void => {
    event.preventDefault();
    void onFile(event.dataTransfer.files[0] ?? null);
  };
  return (
    <section
      className={classes.drop}
      aria-label={t("imports.choose")}
      onDragOver={(event) => event.preventDefault()}
      onDrop={drop}
    >
      <Icon name="upload" size={24} />
      <div>
        <strong>{fileName ?? t("imports.drop")}</strong>
        <p className={classes.soft}>{t("imports.drop.hint")}</p>
      </div>
      <FileButton accept=".csv,.tsv,.txt,text/csv" onChange={(file) => void onFile(file)}>
        {(props) => (
          <Button {...props} variant={fileName === null ? "filled" : "default"} size="sm">
            {t(fileName === null ? "imports.choose" : "imports.other")}
          </Button>
        )}
      </FileButton>
    </section>
  );
}
