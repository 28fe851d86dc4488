/** The files just uploaded, or why they were rejected; each entry stays until it is dismissed. */
import { ActionIcon, Button, FileButton, Progress } from "@mantine/core";
import { ApiError } from "@shared/api/request";
import { number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import type { JSX, ReactNode } from "react";
import { Link } from "wouter";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import classes from "./Captures.module.css";
import { missingCompanion, type Phase, type Upload, type Uploads } from "./useUploads";

export function UploadList({ uploads }: { readonly uploads: Uploads }): JSX.Element | null {
  const { t } = useTexts();
  if (uploads.uploads.length + uploads.lonely.length === 0) return null;
  return (
    <ul className={classes.uploads} aria-label={t("captures.uploads")}>
      {uploads.lonely.map((file) => (
        <IncompletePair key={`${file.name} ${file.lastModified}`} file={file} uploads={uploads} />
      ))}
      {uploads.uploads.map((upload) => (
        <Row
          key={upload.id}
          name={nameOf(upload)}
          tone={upload.phase.at}
          onDismiss={() => uploads.dismiss(upload.id)}
        >
          <PhaseWords upload={upload} onRetry={() => uploads.retry(upload)} />
        </Row>
      ))}
    </ul>
  );
}

const nameOf = ({ files: { file, companion } }: Upload): string =>
  companion === null ? file.name : `${file.name} + ${companion.name}`;

interface RowProps {
  readonly name: string;
  readonly tone: Phase["at"] | "lonely";
  readonly onDismiss: () => void;
  readonly children: ReactNode;
}

const ICONS = {
  waiting: "clock",
  sending: "upload",
  reading: "document",
  done: "check",
  refused: "alert",
  lonely: "link",
} as const;

function Row({ name, tone, onDismiss, children }: RowProps): JSX.Element {
  const { t } = useTexts();
  const isUnderWay = tone === "sending" || tone === "reading" || tone === "waiting";
  return (
    <li className={classes.upload} data-tone={tone}>
      <Icon name={ICONS[tone]} />
      <div className={classes.uploadWords}>
        <strong className={classes.fileName}>{name}</strong>
        {children}
      </div>
      {!isUnderWay && (
        <ActionIcon
          variant="subtle"
          color="gray"
          aria-label={t("captures.upload.dismiss", { name })}
          onClick={onDismiss}
        >
          <Icon name="close" size={16} />
        </ActionIcon>
      )}
    </li>
  );
}

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
    case "sending": {
      const percent = Math.round(100 * phase.share);
      const words = t("captures.upload.sends", { percent });
      return (
        <>
          <span className={`${classes.soft} numbers`}>{words}</span>
          <Progress value={percent} size="sm" aria-label={words} />
        </>
      );
    }
    case "reading":
      return (
        <>
          <span className={classes.soft}>{t("captures.upload.reads")}</span>
          <Progress
            value={100}
            size="sm"
            animated
            striped
            aria-label={t("captures.upload.reads")}
          />
        </>
      );
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
      return <Refusal error={phase.error} onRetry={onRetry} />;
  }
}

/** The file's name, the reason and the remedy; after a network error the upload can be retried. */
function Refusal({
  error,
  onRetry,
}: {
  readonly error: unknown;
  readonly onRetry: () => void;
}): JSX.Element {
  const { t } = useTexts();
  if (!(error instanceof ApiError)) return <Failure error={error} onRetry={onRetry} />;
  const place = error.details.find(({ message }) => message !== "");
  return (
    <div role="alert" className={classes.refusal}>
      <span>
        <strong>{t("captures.upload.refused")}</strong>
        {place?.line != null && place.line > 0 && (
          <span className={classes.line}>
            {place.path} · {t("captures.upload.line", { line: place.line })}
          </span>
        )}
      </span>
      <span>{place?.message ?? error.message}</span>
      {error.remedy !== null && <span className={classes.soft}>{error.remedy}</span>}
    </div>
  );
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
    <Row name={file.name} tone="lonely" onDismiss={() => uploads.drop(file)}>
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
    </Row>
  );
}
