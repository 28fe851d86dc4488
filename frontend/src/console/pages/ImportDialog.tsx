/** Import a study (or its next version) from a YAML file, and show every problem. */
import { Button, Group, Modal, Stack, Text, Textarea } from "@mantine/core";
import { studies } from "@shared/api/endpoints";
import { ApiError, type Problem } from "@shared/api/request";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useRef, useState } from "react";
import { useLocation } from "wouter";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { TextFileButton } from "../ui/TextFileButton";
import { useSingleSubmit } from "../ui/useSingleSubmit";
import classes from "./ImportDialog.module.css";
import { offsetOfLine, Problems } from "./Problems";

interface ImportDialogProps {
  readonly opened: boolean;
  /** The study that gets a new version; null adds a new study. */
  readonly studyKey: string | null;
  readonly onClose: () => void;
}

export function ImportDialog({ opened, studyKey, onClose }: ImportDialogProps): JSX.Element {
  const { t } = useTexts();
  return (
    <Modal
      opened={opened}
      onClose={onClose}
      size="xl"
      title={t(studyKey === null ? "import.title" : "import.titleVersion")}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      <ImportForm studyKey={studyKey} onClose={onClose} />
    </Modal>
  );
}

function ImportForm({ studyKey, onClose }: Omit<ImportDialogProps, "opened">): JSX.Element {
  const { t } = useTexts();
  const [, navigate] = useLocation();
  const queries = useQueryClient();
  const [yaml, setYaml] = useState("");
  const editor = useRef<HTMLTextAreaElement>(null);
  const check = useMutation({ mutationFn: () => studies.check(yaml) });
  const save = useMutation({
    mutationFn: () => (studyKey === null ? studies.add(yaml) : studies.addVersion(studyKey, yaml)),
    onSuccess: async (study) => {
      await queries.invalidateQueries({ queryKey: ["studies"] });
      onClose();
      navigate(`/studies/${study.key}`);
    },
  });
  const submit = useSingleSubmit(save);
  const change = (text: string) => {
    setYaml(text);
    check.reset();
    save.reset();
  };
  const problems = problemsOf(check.data?.problems, save.error);
  return (
    <Stack>
      <Text c="dimmed">{t("import.lead")}</Text>
      <Source editor={editor} yaml={yaml} rows={problems.length > 0 ? 8 : 14} onChange={change} />
      {problems.length > 0 && (
        <Problems problems={problems} onPick={(line) => moveTo(editor.current, line)} />
      )}
      {check.data?.ok === true && <Notice tone="info" icon="check" title={t("import.fine")} />}
      {check.isError && <Failure error={check.error} />}
      {save.isError && problems.length === 0 && <Failure error={save.error} />}
      <Group justify="flex-end">
        <Button
          variant="default"
          disabled={yaml.trim() === ""}
          loading={check.isPending}
          onClick={() => check.mutate()}
        >
          {t("import.check")}
        </Button>
        <Button
          disabled={yaml.trim() === ""}
          loading={save.isPending}
          onClick={() => {
            check.reset();
            submit();
          }}
        >
          {t(studyKey === null ? "import.save" : "import.saveVersion")}
        </Button>
      </Group>
    </Stack>
  );
}

interface SourceProps {
  readonly editor: React.RefObject<HTMLTextAreaElement | null>;
  readonly yaml: string;
  readonly rows: number;
  readonly onChange: (yaml: string) => void;
}

function Source({ editor, yaml, rows, onChange }: SourceProps): JSX.Element {
  const { t } = useTexts();
  return (
    <>
      <div className={classes.drop}>
        <TextFileButton accept=".yaml,.yml,text/yaml" onText={onChange} />
        <Text size="sm" c="dimmed">
          {t("import.orPaste")}
        </Text>
      </div>
      <Textarea
        ref={editor}
        className={classes.editor ?? ""}
        aria-label={t("import.source")}
        rows={rows}
        spellCheck={false}
        value={yaml}
        onChange={(event) => onChange(event.currentTarget.value)}
      />
    </>
  );
}

function problemsOf(
  checked: readonly Problem[] | undefined,
  error: Error | null,
): readonly Problem[] {
  if (checked !== undefined) return checked;
  return error instanceof ApiError ? error.details : [];
}

/** Move the cursor to the start of a line, so that it is easy to find. */
function moveTo(editor: HTMLTextAreaElement | null, line: number): void {
  if (editor === null) return;
  const [start, end] = offsetOfLine(editor.value, line);
  editor.focus();
  editor.setSelectionRange(start, end);
  const lineHeight = editor.scrollHeight / Math.max(editor.value.split("\n").length, 1);
  editor.scrollTop = Math.max(0, (line - 4) * lineHeight);
}
