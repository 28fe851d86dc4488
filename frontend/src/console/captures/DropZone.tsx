/** The upload of capture files: dropped, or chosen with a button. */

import { CAPTURE_EXTENSIONS, CAPTURE_FORMATS } from "@shared/session/registries.generated";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { DropArea } from "../ui/Uploads";
import classes from "./Captures.module.css";

/** A table may have been saved as text. */
const ACCEPTED = [...CAPTURE_EXTENSIONS, ".txt"].join(",");

export function DropZone({
  onFiles,
}: {
  readonly onFiles: (files: readonly File[]) => void;
}): JSX.Element {
  const { t } = useTexts();
  const formats = CAPTURE_FORMATS.map((format) => t(`format.${format}`)).join(", ");
  return (
    <DropArea
      accept={ACCEPTED}
      drop={t("captures.drop")}
      choose={t("captures.choose")}
      hint={t("captures.drop.hint", { formats })}
      onFiles={onFiles}
    />
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
