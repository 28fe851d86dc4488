/**
 * An instrument to fill in: the tablet's own form, next to the scores with every step of their
 * computation.
 */
import { Button, Center, Loader, SegmentedControl } from "@mantine/core";
import { useDebouncedValue } from "@mantine/hooks";
import { instruments, type TryResult } from "@shared/api/drafts";
import type { Administration, InstrumentPreview } from "@shared/api/types";
import { number } from "@shared/format";
import { EMPTY_DRAFT, type FormDraft } from "@shared/forms/draft";
import { answersOf } from "@shared/forms/questions";
import { formTexts } from "@shared/forms/texts";
import { LANGUAGE_NAMES } from "@shared/i18n/i18n";
import { inLanguage } from "@shared/text";
import { Boundary } from "@shared/ui/Boundary";
import { Notice } from "@shared/ui/Notice";
import { keepPreviousData, useQuery } from "@tanstack/react-query";
import { type JSX, lazy, Suspense, useMemo, useState } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import classes from "./Instruments.module.css";

const FormView = lazy(async () => ({ default: (await import("@shared/forms/FormView")).FormView }));

interface TryItProps {
  readonly preview: InstrumentPreview;
  /** The file to try, stored or not. */
  readonly yaml: string;
}

export function TryIt({ preview, yaml }: TryItProps): JSX.Element {
  const { t, language } = useTexts();
  const [round, setRound] = useState(0);
  const [chosenLanguage, setChosenLanguage] = useState<string>(language);
  const [draft, setDraft] = useState<FormDraft>(EMPTY_DRAFT);
  const shown = preview.languages.includes(chosenLanguage)
    ? chosenLanguage
    : (preview.languages[0] ?? "en");
  const restart = () => {
    setDraft(EMPTY_DRAFT);
    setRound(round + 1);
  };
  return (
    <>
      <div className={classes.tools}>
        <span>{t("try.lead")}</span>
        <SegmentedControl
          aria-label={t("try.language")}
          value={shown}
          onChange={setChosenLanguage}
          data={preview.languages.map((tag) => ({ value: tag, label: LANGUAGE_NAMES[tag] ?? tag }))}
        />
        <Button variant="default" size="xs" onClick={restart}>
          {t("try.again")}
        </Button>
      </div>
      {/* The scores appear with the form, which would push them down. */}
      <Suspense
        fallback={
          <Center mih={240} w="100%">
            <Loader />
          </Center>
        }
      >
        <div className={classes.try}>
          <Boundary>
            <Paper
              key={round}
              preview={preview}
              yaml={yaml}
              language={shown}
              draft={draft}
              onDraft={setDraft}
            />
          </Boundary>
          <Scores preview={preview} yaml={yaml} draft={draft} />
        </div>
      </Suspense>
    </>
  );
}

interface PaperProps extends TryItProps {
  readonly language: string;
  readonly draft: FormDraft;
  readonly onDraft: (draft: FormDraft) => void;
}

function Paper({ preview, yaml, language, draft, onDraft }: PaperProps): JSX.Element {
  const { t } = useTexts();
  const texts = formTexts(t);
  const [done, setDone] = useState(false);
  const [startedAt] = useState(() => new Date());
  // A form that is rendered again keeps its answers: an edit of the file does not empty the page.
  const administration: Administration = useMemo(
    () => ({
      key: `preview ${yaml.length} ${hash(yaml)}`,
      step_index: 0,
      instrument: preview.instrument,
      item_order: preview.item_order,
      seed: preview.seed,
      language,
      languages: [...preview.languages],
    }),
    [preview, yaml, language],
  );
  if (done) return <Notice tone="info" icon="check" title={t("try.complete")} />;
  return (
    <div className={classes.paper} lang={language}>
      <FormView
        administration={administration}
        language={language}
        texts={texts}
        draft={draft}
        startedAt={startedAt}
        busy={false}
        onChange={onDraft}
        onSubmit={() => setDone(true)}
      />
    </div>
  );
}

/** A short hash of a text; a collision would only leave an outdated form on the page. */
function hash(text: string): number {
  let value = 0;
  for (let at = 0; at < text.length; at += 1) value = (value * 31 + text.charCodeAt(at)) | 0;
  return value;
}

function Scores({ preview, yaml, draft }: TryItProps & { readonly draft: FormDraft }): JSX.Element {
  const { t } = useTexts();
  const [settled] = useDebouncedValue(draft.data, 250);
  const query = useQuery({
    queryKey: ["try", yaml, settled],
    queryFn: () => instruments.score(yaml, answersOf(preview.instrument, settled)),
    placeholderData: keepPreviousData,
    gcTime: 0,
  });
  return (
    <section aria-live="polite" aria-label={t("try.scores")}>
      <h2>{t("try.scores")}</h2>
      {query.isError && <Failure error={query.error} />}
      {query.data !== undefined && <Result result={query.data} />}
    </section>
  );
}

function Result({ result }: { readonly result: TryResult }): JSX.Element {
  const { t, language } = useTexts();
  const written = (value: number | null) => (value === null ? "–" : number(value, language, 3));
  return (
    <>
      <table className={`${classes.table} numbers`}>
        <tbody>
          {result.scores.map((score) => (
            <tr key={score.key}>
              <th scope="row">
                {inLanguage(score.label, language)}
                <div className={classes.formula}>{score.filled_in}</div>
                {score.missing.length > 0 && (
                  <div className={classes.small}>
                    {t("try.missing", { items: score.missing.join(", ") })}
                  </div>
                )}
              </th>
              <td className={classes.value}>{written(score.value)}</td>
            </tr>
          ))}
        </tbody>
      </table>
      {result.scores.length === 0 && <p>{t("instruments.noScores")}</p>}
      <details className={classes.steps}>
        <summary>{t("try.items")}</summary>
        <table className={`${classes.table} numbers`}>
          <thead>
            <tr>
              <th scope="col">{t("try.item")}</th>
              <th scope="col">{t("try.raw")}</th>
              <th scope="col">{t("try.recoded")}</th>
            </tr>
          </thead>
          <tbody>
            {result.items.map((item) => (
              <tr key={item.item}>
                <th scope="row">
                  {item.item}
                  {!item.scored && <div className={classes.small}>{t("try.unscored")}</div>}
                </th>
                <td>{written(item.raw)}</td>
                <td>{written(item.recoded)}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </details>
    </>
  );
}
