/** What can be brought, and which programs write it. */
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./Captures.module.css";

const FORMATS = [
  ...(["bvh", "motive-csv", "asf-amc", "c3d", "trc"] as const),
  ...(["vicon-tracker-csv", "uxf-tracker", "quest-log"] as const),
];
type Format = (typeof FORMATS)[number];

const isFormat = (key: string): key is Format => (FORMATS as readonly string[]).includes(key);

/** The name of a format; of one that this page does not know, its key. */
export function useFormatName(): (format: string) => string {
  const { t } = useTexts();
  return (format) => (isFormat(format) ? t(`format.${format}`) : format);
}

export function Formats(): JSX.Element {
  const { t } = useTexts();
  return (
    <dl className={classes.formats}>
      {FORMATS.map((format) => (
        <div key={format}>
          <dt>{t(`format.${format}`)}</dt>
          <dd>{t(`format.${format}.from`)}</dd>
        </div>
      ))}
    </dl>
  );
}
