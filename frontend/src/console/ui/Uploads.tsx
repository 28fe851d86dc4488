/** Uploads: an area to drop files on, and a list of what became of each file. */
import { ActionIcon, Button, FileButton, Progress } from "@mantine/core";
import { ApiError } from "@shared/api/request";
import { Icon } from "@shared/ui/Icon";
import { type DragEvent, type JSX, type ReactNode, useState } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import classes from "./Uploads.module.css";

interface DropAreaProps {
  /** The extensions of files that can be chosen, such as `.bvh,.csv`. */
  readonly accept: string;
  readonly drop: string;
  readonly choose: string;
  readonly hint: string;
  readonly onFiles: (files: readonly File[]) => void;
}

/** An area to drop files on, with a button to choose them instead. */
export function DropArea({ accept, drop, choose, hint, onFiles }: DropAreaProps): JSX.Element {
  const [isDraggedOver, setIsDraggedOver] = useState(false);
  const stop = (event: DragEvent, isOver: boolean) => {
    event.preventDefault();
    setIsDraggedOver(isOver);
  };
  return (
    <section
      className={classes.drop}
      data-over={isDraggedOver || undefined}
      aria-label={choose}
      onDragOver={(event) => stop(event, true)}
      onDragLeave={(event) => stop(event, false)}
      onDrop={(event) => {
        stop(event, false);
        onFiles([...event.dataTransfer.files]);
      }}
    >
      <Icon name="upload" size={28} />
      <div className={classes.dropWords}>
        <div className={classes.dropRow}>
          <span>{drop}</span>
          <FileButton multiple accept={accept} onChange={onFiles}>
            {(props) => (
              <Button {...props} size="xs">
                {choose}
              </Button>
            )}
          </FileButton>
        </div>
        <span className={classes.soft}>{hint}</span>
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
  lonely: "link",
} as const;

/** Where an upload is; `lonely`: the second file of a pair is missing. */
export type UploadTone = keyof typeof ICONS;

export function UploadEntries({ children }: { readonly children: ReactNode }): JSX.Element {
  const { t } = useTexts();
  return (
    <ul className={classes.uploads} aria-label={t("captures.uploads")}>
      {children}
    </ul>
  );
}

interface UploadEntryProps {
  readonly name: string;
  readonly tone: UploadTone;
  readonly onDismiss: () => void;
  readonly children: ReactNode;
}

/** One file of the list; it can be dismissed once nothing is under way. */
export function UploadEntry({ name, tone, onDismiss, children }: UploadEntryProps): JSX.Element {
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

/** How much of a file was sent; `share` from 0 to 1. */
export function SendingWords({ share }: { readonly share: number }): JSX.Element {
  const { t } = useTexts();
  const percent = Math.round(100 * share);
  const words = t("captures.upload.sends", { percent });
  return (
    <>
      <span className={`${classes.soft} numbers`}>{words}</span>
      <Progress value={percent} size="sm" aria-label={words} />
    </>
  );
}

/** Shows that the server is reading a file; its progress is unknown. */
export function ReadingWords({ words }: { readonly words: string }): JSX.Element {
  return (
    <>
      <span className={classes.soft}>{words}</span>
      <Progress value={100} size="sm" animated striped aria-label={words} />
    </>
  );
}

interface UploadFailureProps {
  readonly error: unknown;
  readonly onRetry: () => void;
}

/** Why a file was refused, where in it, and what to do; a network error can be retried. */
export function UploadFailure({ error, onRetry }: UploadFailureProps): JSX.Element {
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
