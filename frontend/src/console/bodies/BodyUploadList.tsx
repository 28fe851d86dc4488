/** The upload of bodies: where to drop files, and what became of each. */
import { Button } from "@mantine/core";
import type { JSX } from "react";
import { Link } from "wouter";
import { useTexts } from "../i18n";
import {
  DropArea,
  ReadingWords,
  SendingWords,
  UploadEntries,
  UploadEntry,
  UploadFailure,
} from "../ui/Uploads";
import uploads from "../ui/Uploads.module.css";
import type { BodyUpload, BodyUploads } from "./useBodyUploads";

const ACCEPTED = ".vrm,.glb,.gltf";

export function BodyDropZone({
  onFiles,
}: {
  readonly onFiles: (files: readonly File[]) => void;
}): JSX.Element {
  const { t } = useTexts();
  return (
    <DropArea
      accept={ACCEPTED}
      drop={t("bodies.drop")}
      choose={t("bodies.choose")}
      hint={t("bodies.drop.hint")}
      onFiles={onFiles}
    />
  );
}

export function BodyUploadList({ queue }: { readonly queue: BodyUploads }): JSX.Element | null {
  if (queue.uploads.length === 0) return null;
  return (
    <UploadEntries>
      {queue.uploads.map((upload) => (
        <UploadEntry
          key={upload.id}
          name={upload.file.name}
          tone={upload.phase.at}
          onDismiss={() => queue.dismiss(upload.id)}
        >
          <PhaseWords upload={upload} onRetry={() => queue.retry(upload)} />
        </UploadEntry>
      ))}
    </UploadEntries>
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
    case "sending":
      return <SendingWords share={phase.share} />;
    case "reading":
      return <ReadingWords words={t("bodies.upload.reads")} />;
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
      return <UploadFailure error={phase.error} onRetry={onRetry} />;
  }
}
