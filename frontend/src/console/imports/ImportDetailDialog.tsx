/** One import: its source, the results of its scores, its file, and how to undo it. */
import { Button, Group, Modal, Stack, TextInput, Title } from "@mantine/core";
import { type AnswerImport, type ImportDetail, imports } from "@shared/api/imports";
import { dateTime } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { importQuery } from "../queries";
import { Loaded } from "../ui/Loaded";
import { useShown } from "../ui/page";
import { ImportedScore } from "./ImportedScore";
import classes from "./Imports.module.css";

interface DialogProps {
  readonly studyKey: string;
  /** The import to show; null while closed. */
  readonly id: string | null;
  readonly onClose: () => void;
}

export function ImportDetailDialog({ studyKey, id, onClose }: DialogProps): JSX.Element {
  const { t } = useTexts();
  const shown = useShown(id);
  return (
    <Modal
      opened={id !== null}
      onClose={onClose}
      size="68rem"
      title={t("imports.one")}
      classNames={{ content: classes.dialog ?? "" }}
      closeButtonProps={{ "aria-label": t("action.close") }}
    >
      {shown !== null && <Detail studyKey={studyKey} id={shown} />}
    </Modal>
  );
}

function Detail({ studyKey, id }: { readonly studyKey: string; readonly id: string }): JSX.Element {
  const query = useQuery(importQuery(studyKey, id));
  return (
    <Loaded query={query}>{(found) => <ImportResults studyKey={studyKey} found={found} />}</Loaded>
  );
}

interface ImportResultsProps {
  readonly studyKey: string;
  readonly found: ImportDetail;
}

function ImportResults({ studyKey, found }: ImportResultsProps): JSX.Element {
  const { t, language } = useTexts();
  const can = usePermissions();
  const { view, results } = found;
  const by = view.imported_by.replace("account:", "");
  return (
    <Stack>
      <div>
        <Title order={3}>{view.file_name}</Title>
        <p className={classes.soft}>
          {t("imports.origin", { by, when: dateTime(view.imported_at, language) })}{" "}
          {t("imports.counts", { forms: view.forms, people: view.participants })}
        </p>
        <p className={classes.hash}>sha256 {view.content_hash}</p>
      </div>
      {view.undone_at === null ? (
        <Notice tone="info" title={t("imports.apart")}>
          {t("imports.apart.body")}
        </Notice>
      ) : (
        <Notice tone="warn" title={t("imports.undone.title")}>
          {t("imports.undone.body", {
            by: (view.undone_by ?? "").replace("account:", ""),
            when: dateTime(view.undone_at, language),
            reason: view.undone_reason ?? "",
          })}
        </Notice>
      )}
      {results.map((result) => (
        <ImportedScore key={result.score} result={result} />
      ))}
      {view.undone_at === null && (
        <Group>
          <Button
            component="a"
            href={imports.tableUrl(studyKey, view.id)}
            variant="default"
            leftSection={<Icon name="download" size={17} />}
          >
            {t("imports.csv")}
          </Button>
        </Group>
      )}
      {view.undone_at === null && can("design") && <Undo studyKey={studyKey} view={view} />}
    </Stack>
  );
}

function Undo({
  studyKey,
  view,
}: {
  readonly studyKey: string;
  readonly view: AnswerImport;
}): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [reason, setReason] = useState("");
  const undo = useMutation({
    mutationFn: () => imports.undo(studyKey, view.id, reason.trim()),
    onSuccess: () => queries.invalidateQueries({ queryKey: ["studies", studyKey, "imports"] }),
  });
  return (
    <form
      className={classes.undo}
      onSubmit={(event) => {
        event.preventDefault();
        if (reason.trim().length >= 3) undo.mutate();
      }}
    >
      <TextInput
        label={t("imports.undo.why")}
        description={t("imports.undo.about")}
        maxLength={2000}
        value={reason}
        onChange={(event) => setReason(event.currentTarget.value)}
      />
      <Button
        type="submit"
        color="red"
        variant="outline"
        disabled={reason.trim().length < 3}
        loading={undo.isPending}
      >
        {t("imports.undo")}
      </Button>
      {undo.isError && <Failure error={undo.error} />}
    </form>
  );
}
