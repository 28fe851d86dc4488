/** Every item in all languages side by side, with its possible answers. */
import type { InstrumentPreview, Item, Scale } from "@shared/api/types";
import { LANGUAGE_NAMES } from "@shared/i18n/i18n";
import { inLanguage } from "@shared/text";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { ScrollBox } from "../ui/tables";
import classes from "./Instruments.module.css";

export function Items({ preview }: { readonly preview: InstrumentPreview }): JSX.Element {
  const { t } = useTexts();
  const { instrument, languages } = preview;
  return (
    <>
      <Shuffle preview={preview} />
      <ScrollBox label={t("instrument.answers")} className={classes.scroll}>
        <table className={classes.table}>
          <thead>
            <tr>
              <th scope="col">{t("instrument.key")}</th>
              {languages.map((tag) => (
                <th key={tag} scope="col">
                  {LANGUAGE_NAMES[tag] ?? tag}
                </th>
              ))}
              <th scope="col">{t("instrument.answers")}</th>
            </tr>
          </thead>
          <tbody>
            {instrument.stem != null && (
              <tr>
                <th scope="row">
                  <code>stem</code>
                </th>
                {languages.map((tag) => (
                  <td key={tag} lang={tag}>
                    {instrument.stem?.[tag]}
                  </td>
                ))}
                <td />
              </tr>
            )}
            {instrument.items.map((item) => (
              <Row key={item.key} item={item} preview={preview} />
            ))}
          </tbody>
        </table>
      </ScrollBox>
    </>
  );
}

interface RowProps {
  readonly item: Item;
  readonly preview: InstrumentPreview;
}

function Row({ item, preview }: RowProps): JSX.Element {
  const { t } = useTexts();
  const marks = [
    item.reverse_keyed === true ? t("instrument.reversed") : "",
    item.required === false ? t("instrument.optional") : "",
  ].filter((mark) => mark !== "");
  return (
    <tr>
      <th scope="row">
        <code>{item.key}</code>
        {marks.length > 0 && <div className={classes.small}>{marks.join(", ")}</div>}
      </th>
      {preview.languages.map((tag) => (
        <td key={tag} lang={tag}>
          {item.text[tag]}
        </td>
      ))}
      <td>
        <Answers item={item} scale={item.scale ?? preview.instrument.scale ?? null} />
      </td>
    </tr>
  );
}

interface AnswersProps {
  readonly item: Item;
  readonly scale: Scale | null;
}

function Answers({ item, scale }: AnswersProps): JSX.Element | null {
  const { t, language } = useTexts();
  switch (item.type) {
    case "likert":
      return scale === null ? null : (
        <>
          {(scale.step ?? 1) === 1
            ? t("instrument.fromTo", { low: scale.minimum, high: scale.maximum })
            : t("instrument.steps", {
                low: scale.minimum,
                high: scale.maximum,
                step: scale.step ?? 1,
              })}
          {scale.labels.length > 0 && (
            <div className={classes.small}>
              {[scale.labels[0], scale.labels.at(-1)]
                .map((label) => inLanguage(label, language))
                .join(" … ")}
            </div>
          )}
        </>
      );
    case "choice":
      return <>{(item.choices ?? []).map(({ label }) => inLanguage(label, language)).join(", ")}</>;
    case "integer":
    case "number": {
      const range =
        item.minimum != null && item.maximum != null
          ? t("instrument.fromTo", { low: item.minimum, high: item.maximum })
          : t(`instrument.type.${item.type}`);
      return <>{[range, item.unit ?? ""].join(" ").trim()}</>;
    }
    default:
      return <>{t(`instrument.type.${item.type}`)}</>;
  }
}

function Shuffle({ preview }: { readonly preview: InstrumentPreview }): JSX.Element | null {
  const { t } = useTexts();
  const { shuffle = false, last = [] } = preview.instrument;
  if (!shuffle) return null;
  return (
    <p className={classes.lead}>
      {last.length === 0
        ? t("instrument.shuffledAll")
        : t("instrument.shuffled", { last: last.join(", ") })}
    </p>
  );
}
