/** The participant's answers after the phase: the scores, then every answer in its words. */
import type { Replay } from "@shared/api/replays";
import type { Form } from "@shared/api/rights";
import { number } from "@shared/format";
import { inLanguage } from "@shared/text";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import { formsQuery } from "../queries";
import { answerText } from "../rights/answerText";
import { Loaded } from "../ui/Loaded";
import classes from "./Replay.module.css";

export function AnswersAfter({ replay }: { readonly replay: Replay }): JSX.Element {
  const { t } = useTexts();
  const forms = useQuery(formsQuery(replay.session_id));
  if (replay.administrations.length === 0) {
    return <p className={classes.soft}>{t("replay.answers.none")}</p>;
  }
  return (
    <Loaded query={forms}>
      {(all) => (
        <div className={classes.forms}>
          {replay.administrations.map((name) => {
            const form = all.find(({ administration }) => administration === name);
            return form === undefined ? null : <OneForm key={name} form={form} />;
          })}
        </div>
      )}
    </Loaded>
  );
}

function OneForm({ form }: { readonly form: Form }): JSX.Element {
  const { t, language } = useTexts();
  const words = { leftOut: t("answers.leftOut"), yes: t("answers.yes"), no: t("answers.no") };
  return (
    <section>
      <h3 className={classes.formTitle}>{inLanguage(form.definition.title, language)}</h3>
      {form.score_views.length > 0 && (
        <dl className={`${classes.scores} numbers`}>
          {form.score_views.map(({ key, label, value }) => (
            <div key={key}>
              <dt>{label}</dt>
              <dd>{value === null ? t("scores.incomplete") : number(value, language)}</dd>
            </div>
          ))}
        </dl>
      )}
      <dl className={classes.answers}>
        {form.definition.items
          .filter(({ key }) => key in form.answers)
          .map((item) => (
            <div key={item.key}>
              <dt>{inLanguage(item.text, language)}</dt>
              <dd>{answerText(form, item, form.answers[item.key] ?? null, language, words)}</dd>
            </div>
          ))}
      </dl>
    </section>
  );
}
