/** The upload of bodies: where to drop files, and what became of each. */
import { ActionIcon, Button, FileButton, Progress } from "@mantine/core";
import { ApiError } from "@shared/api/request";
import { Icon } from "@shared/ui/Icon";
import { type DragEvent, type JSX, useState } from "react";
import { Link } from "wouter";
import uploads from "../captures/Captures.module.css";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import type { BodyUpload, BodyUploads } from "./useBodyUploads";

const ACCEPTED = ".vrm,.glb,.gltf";

export function BodyDropZone({
  onFiles,
}: {
  readonly onFiles: (files: readonly File[]) => void;
}): JSX.Element {
  const { t } = useTexts();
  const [isDraggedOver, setIsDraggedOver] = useState(false);
  const stop = (event: DragEvent, isOver: boolean) => {
    event.preventDefault();
    setIsDraggedOver(isOver);
  };
  return (
    <section
      className={uploads.drop}
      data-over={isDraggedOver || undefined}
      aria-label={t("bodies.choose")}
      onDragOver={(event) => stop(event, true)}
      onDragLeave={(event) => stop(event, false)}
      onDrop={(event) => {
        stop(event, false);
        onFiles([...event.dataTransfer.files]);
      }}
    >
      <Icon name="upload" size={28} />
      <div className={uploads.dropWords}>
        <div className={uploads.dropRow}>
          <span>{t("bodies.drop")}</span>
          <FileButton multiple accept={ACCEPTED} onChange={onFiles}>
            {(props) => (
              <Button {...props} size="xs">
                {t("bodies.choose")}
              </Button>
            )}
          </FileButton>
        </div>
        <span className={uploads.soft}>{t("bodies.drop.hint")}</span>
      </div>
    </section>
  );
}

const ICONS = {
  waiting: "clock",
  sending: "upload",
  reading: "document",
  done: "check",
  refused: "alert",
} as const;

export function BodyUploadList({ queue }: { readonly queue: BodyUploads }): JSX.Element | null {
  const { t } = useTexts();
  if (queue.uploads.length === 0) return null;
  return (
    <ul className={uploads.uploads} aria-label={t("captures.uploads")}>
      {queue.uploads.map((upload) => (
        <li key={upload.id} className={uploads.upload} data-tone={upload.phase.at}>
          <Icon name={ICONS[upload.phase.at]} />
          <div className={uploads.uploadWords}>
            <strong className={uploads.fileName}>{upload.file.name}</strong>
            <PhaseWords upload={upload} onRetry={() => queue.retry(upload)} />
          </div>
          {(upload.phase.at === "done" || upload.phase.at === "refused") && (
            <ActionIcon
              variant="subtle"
              color="gray"
              aria-label={t("captures.upload.dismiss", { name: upload.file.name })}
              onClick={() => queue.dismiss(upload.id)}
            >
              <Icon name="close" size={16} />
            </ActionIcon>
          )}
        </li>
      ))}
    </ul>
  );
}

interface PhaseProps {
  readonly upload: BodyUpload;
  readonly onRetry: () => void;
}

function PhaseWords({ upload, onRetry }: PhaseProps): JSX.Element {
  const { t } = useTexts();
  const { phase } = upload;
  switch (phase.at) {
    case "waiting":
      return <span className={uploads.soft}>{t("captures.upload.waits")}</span>;
    case "sending": {
      const percent = Math.round(100 * phase.share);
      const words = t("captures.upload.sends", { percent });
      return (
        <>
          <span className={`${uploads.soft} numbers`}>{words}</span>
          <Progress value={percent} size="sm" aria-label={words} />
        </>
      );
    }
    case "reading":
      return <span className={uploads.soft}>{t("bodies.upload.reads")}</span>;
    case "done": {
      const { stored, isNew } = phase.uploaded;
      return (
        <span className={uploads.uploadRow}>
          <span className={uploads.soft}>
            {t(isNew ? "bodies.upload.done" : "captures.upload.known")}
          </span>
          <Button
            component={Link}
            href={`/bodies/${stored.content_hash}`}
            size="compact-sm"
            variant="light"
            aria-label={t("captures.upload.open", { name: upload.file.name })}
          >
            {t("captures.upload.open.short")}
          </Button>
        </span>
      );
    }
    case "refused":
      return <Refusal error={phase.error} onRetry={onRetry} />;
  }
}

/** The reason and the remedy; after a network error the upload can be retried. */
function Refusal({
  error,
  onRetry,
}: {
  readonly error: unknown;
  readonly onRetry: () => void;
}): JSX.Element {
  const { t } = useTexts();
  if (!(error instanceof ApiError)) return <Failure error={error} onRetry={onRetry} />;
  return (
    <div role="alert" className={uploads.refusal}>
      <strong>{t("captures.upload.refused")}</strong>
      <span>{error.message}</span>
      {error.remedy !== null && <span className={uploads.soft}>{error.remedy}</span>}
    </div>
  );
}
