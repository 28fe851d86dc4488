/** The files just uploaded, or why they were rejected; each entry stays until it is dismissed. */
import { Button, FileButton } from "@mantine/core";
import { number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import type { JSX } from "react";
import { Link } from "wouter";
import { useTexts } from "../i18n";
import {
  ReadingWords,
  SendingWords,
  UploadEntries,
  UploadEntry,
  UploadFailure,
} from "../ui/Uploads";
import classes from "../ui/Uploads.module.css";
import { missingCompanion, type Upload, type Uploads } from "./useUploads";

export function UploadList({ uploads }: { readonly uploads: Uploads }): JSX.Element | null {
  if (uploads.uploads.length + uploads.lonely.length === 0) return null;
  return (
    <UploadEntries>
      {uploads.lonely.map((file) => (
        <IncompletePair key={`${file.name} ${file.lastModified}`} file={file} uploads={uploads} />
      ))}
      {uploads.uploads.map((upload) => (
        <UploadEntry
          key={upload.id}
          name={nameOf(upload)}
          tone={upload.phase.at}
          onDismiss={() => uploads.dismiss(upload.id)}
        >
          <PhaseWords upload={upload} onRetry={() => uploads.retry(upload)} />
        </UploadEntry>
      ))}
    </UploadEntries>
  );
}

const nameOf = ({ files: { file, companion } }: Upload): string =>
  companion === null ? file.name : `${file.name} + ${companion.name}`;

interface PhaseProps {
  readonly upload: Upload;
  readonly onRetry: () => void;
}

function PhaseWords({ upload, onRetry }: PhaseProps): JSX.Element {
  const { t, language } = useTexts();
  const { phase } = upload;
  switch (phase.at) {
    case "waiting":
      return <span className={classes.soft}>{t("captures.upload.waits")}</span>;
    case "sending":
      return <SendingWords share={phase.share} />;
    case "reading":
      return <ReadingWords words={t("captures.upload.reads")} />;
    case "done": {
      const { capture, isNew } = phase.uploaded;
      return (
        <span className={classes.uploadRow}>
          <span className={`${classes.soft} numbers`}>
            {t("captures.upload.done", {
              frames: number(capture.frames, language),
              rate: number(capture.rate_hz, language),
              duration: number(capture.duration_s, language),
            })}
            {!isNew && ` · ${t("captures.upload.known")}`}
          </span>
          <Button
            component={Link}
            href={`/captures/${capture.id}`}
            size="compact-sm"
            variant="light"
            aria-label={t("captures.upload.open", { name: capture.title })}
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

function IncompletePair({
  file,
  uploads,
}: {
  readonly file: File;
  readonly uploads: Uploads;
}): JSX.Element {
  const { t } = useTexts();
  const missing = missingCompanion(file);
  const words = t("captures.upload.lonely", { missing });
  return (
    <UploadEntry name={file.name} tone="lonely" onDismiss={() => uploads.drop(file)}>
      <div role="alert" className={classes.refusal}>
        <strong>{words}</strong>
        <span>
          {t(missing === ".asf" ? "captures.upload.lonely.asf" : "captures.upload.lonely.amc")}
        </span>
        <span>
          <FileButton accept={missing} onChange={(added) => added !== null && uploads.add([added])}>
            {(props) => (
              <Button {...props} size="compact-sm" leftSection={<Icon name="add" size={14} />}>
                {t("captures.upload.add", { missing })}
              </Button>
            )}
          </FileButton>
        </span>
      </div>
    </UploadEntry>
  );
}
