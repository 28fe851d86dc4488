/** The head of a capture's page: its title, its properties and the file it came from. */
import { ActionIcon, Button, TextInput, Title, Tooltip } from "@mantine/core";
import { type Capture, captures } from "@shared/api/captures";
import { dateTime, number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { useLocation } from "wouter";
import { nameOf } from "../account";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import classes from "./Capture.module.css";
import { DeleteCapture } from "./DeleteCapture";
import { useFormatName } from "./DropZone";
import { captureQuery, capturesQuery } from "./queries";

export function CaptureHead({ capture }: { readonly capture: Capture }): JSX.Element {
  const { t } = useTexts();
  const canWrite = usePermissions()("capture");
  const [, navigate] = useLocation();
  const [leaving, setLeaving] = useState(false);
  return (
    <div className={classes.head}>
      <div>
        <CaptureTitle capture={capture} canWrite={canWrite} />
        <Facts capture={capture} />
      </div>
      <div className={classes.actions}>
        <FileLink capture={capture} companion={false} />
        {capture.companion_name !== null && <FileLink capture={capture} companion />}
        {canWrite && (
          <Button variant="subtle" color="red" size="xs" onClick={() => setLeaving(true)}>
            {t("captures.delete.short")}
          </Button>
        )}
      </div>
      <DeleteCapture
        capture={leaving ? capture : null}
        onClose={() => setLeaving(false)}
        onDeleted={() => navigate("/captures")}
      />
    </div>
  );
}

function FileLink({
  capture,
  companion,
}: {
  readonly capture: Capture;
  readonly companion: boolean;
}): JSX.Element {
  const { t } = useTexts();
  const name = companion ? capture.companion_name : capture.file_name;
  return (
    <Button
      component="a"
      href={captures.fileUrl(capture.id, companion)}
      download={name ?? undefined}
      variant="default"
      size="xs"
      title={name ?? ""}
      leftSection={<Icon name="download" size={15} />}
    >
      {companion ? t("capture.file.companion", { name: name ?? "" }) : t("capture.file")}
    </Button>
  );
}

function Facts({ capture }: { readonly capture: Capture }): JSX.Element {
  const { t, language } = useTexts();
  const formatName = useFormatName();
  const rate = number(capture.rate_hz, language);
  return (
    <div className={`${classes.meta} numbers`}>
      {capture.title !== capture.file_name && <span>{capture.file_name}</span>}
      <span>{formatName(capture.format)}</span>
      <span>{t(`captures.kind.${capture.kind}`, { count: capture.tracks })}</span>
      <span>
        {t("captures.seconds", { value: number(capture.duration_s, language) })}
        {", "}
        {t("captures.frames", { frames: number(capture.frames, language), rate })}
      </span>
      <span>
        {dateTime(capture.at, language)} {t("captures.by", { by: nameOf(capture.by) })}
      </span>
    </div>
  );
}

interface TitleProps {
  readonly capture: Capture;
  readonly canWrite: boolean;
}

function CaptureTitle({ capture, canWrite }: TitleProps): JSX.Element {
  const { t } = useTexts();
  const [editing, setEditing] = useState(false);
  if (editing) return <TitleForm capture={capture} onDone={() => setEditing(false)} />;
  return (
    <div className={classes.titleRow}>
      <Title order={1} className={classes.title ?? ""}>
        {capture.title}
      </Title>
      {canWrite && (
        <Tooltip label={t("capture.rename")}>
          <ActionIcon
            variant="subtle"
            color="gray"
            aria-label={t("capture.rename")}
            onClick={() => setEditing(true)}
          >
            <Icon name="note" size={18} />
          </ActionIcon>
        </Tooltip>
      )}
    </div>
  );
}

function TitleForm({
  capture,
  onDone,
}: {
  readonly capture: Capture;
  readonly onDone: () => void;
}): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const [title, setTitle] = useState(capture.title);
  const rename = useMutation({
    mutationFn: () => captures.change(capture.id, { title: title.trim() }),
    onSuccess: (changed) => {
      queries.setQueryData(captureQuery(capture.id).queryKey, changed);
      void queries.invalidateQueries({ queryKey: capturesQuery.queryKey, exact: true });
      onDone();
    },
  });
  return (
    <form
      className={classes.titleForm}
      onSubmit={(event) => {
        event.preventDefault();
        if (title.trim() !== "") rename.mutate();
      }}
    >
      <TextInput
        aria-label={t("capture.rename.field")}
        autoFocus
        maxLength={200}
        value={title}
        onFocus={(event) => event.currentTarget.select()}
        onChange={(event) => setTitle(event.currentTarget.value)}
        onKeyDown={(event) => event.key === "Escape" && onDone()}
      />
      <Button type="submit" loading={rename.isPending} disabled={title.trim() === ""}>
        {t("capture.rename.save")}
      </Button>
      <Button variant="default" onClick={onDone}>
        {t("action.cancel")}
      </Button>
      {rename.isError && <Failure error={rename.error} />}
    </form>
  );
}
