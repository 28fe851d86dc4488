/** The upload of capture files: dropped, or chosen with a button. */
import { Button, FileButton } from "@mantine/core";
import { Icon } from "@shared/ui/Icon";
import { type DragEvent, type JSX, useState } from "react";
import { useTexts } from "../i18n";
import { CAPTURE_EXTENSIONS, CAPTURE_FORMATS } from "../i18n/registries.generated";
import classes from "./Captures.module.css";

/** A table may have been saved as text. */
const ACCEPTED = [...CAPTURE_EXTENSIONS, ".txt"].join(",");

export function DropZone({
  onFiles,
}: {
  readonly onFiles: (files: readonly File[]) => void;
}): JSX.Element {
  const { t } = useTexts();
  const [isDraggedOver, setIsDraggedOver] = useState(false);
  const formats = CAPTURE_FORMATS.map((format) => t(`format.${format}`)).join(", ");
  const stop = (event: DragEvent, isOver: boolean) => {
    event.preventDefault();
    setIsDraggedOver(isOver);
  };
  return (
    <section
      className={classes.drop}
      data-over={isDraggedOver || undefined}
      aria-label={t("captures.choose")}
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
          <span>{t("captures.drop")}</span>
          <FileButton multiple accept={ACCEPTED} onChange={onFiles}>
            {(props) => (
              <Button {...props} size="xs">
                {t("captures.choose")}
              </Button>
            )}
          </FileButton>
        </div>
        <span className={classes.soft}>{t("captures.drop.hint", { formats })}</span>
      </div>
    </section>
  );
}

type Format = (typeof CAPTURE_FORMATS)[number];

const isFormat = (key: string): key is Format =>
  (CAPTURE_FORMATS as readonly string[]).includes(key);

/** Return a function for the name of a format; an unknown format is called by its key. */
export function useFormatName(): (format: string) => string {
  const { t } = useTexts();
  return (format) => (isFormat(format) ? t(`format.${format}`) : format);
}

/** The supported formats, and which programs write them. */
export function Formats(): JSX.Element {
  const { t } = useTexts();
  return (
    <dl className={classes.formats}>
      {CAPTURE_FORMATS.map((format) => (
        <div key={format}>
          <dt>{t(`format.${format}`)}</dt>
          <dd>{t(`format.${format}.from`)}</dd>
        </div>
      ))}
    </dl>
  );
}
