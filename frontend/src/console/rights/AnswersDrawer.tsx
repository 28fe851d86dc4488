/** All answers of a session with their corrections, and a form to correct one. */
import { Button } from "@mantine/core";
import type { Form } from "@shared/api/rights";
import type { Item } from "@shared/api/types";
import { dateTime } from "@shared/format";
import { inLanguage } from "@shared/text";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { useTexts } from "../i18n";
import { formsQuery } from "../queries";
import { Loaded } from "../ui/Loaded";
import { RecordDrawer } from "../ui/RecordDrawer";
import { answerText } from "./answerText";
import { CorrectAnswer } from "./CorrectAnswer";
import classes from "./Rights.module.css";

interface AnswersDrawerProps {
  readonly sessionId: string;
  readonly code: string;
  readonly opened: boolean;
  readonly onClose: () => void;
}

export function AnswersDrawer({
  sessionId,
  code,
  opened,
  onClose,
}: AnswersDrawerProps): JSX.Element {
  const { t } = useTexts();
  return (
    <RecordDrawer title={t("answers.title", { code })} opened={opened} onClose={onClose}>
      <Forms sessionId={sessionId} />
    </RecordDrawer>
  );
}

function Forms({ sessionId }: { readonly sessionId: string }): JSX.Element {
  const { t } = useTexts();
  return (
    <Loaded query={useQuery(formsQuery(sessionId))}>
      {(forms) =>
        forms.length === 0 ? (
          <p className={classes.soft}>{t("answers.none")}</p>
        ) : (
          forms.map((form) => (
            <OneForm key={form.submission_id} sessionId={sessionId} form={form} />
          ))
        )
      }
    </Loaded>
  );
}

interface OneFormProps {
  readonly sessionId: string;
  readonly form: Form;
}

function OneForm({ sessionId, form }: OneFormProps): JSX.Element {
  const { language } = useTexts();
  return (
    <section className={classes.form}>
      <h3>{inLanguage(form.definition.title, language)}</h3>
      <p className={classes.soft}>{dateTime(form.submitted_at, language)}</p>
      <ul className={classes.answers}>
        {form.definition.items
          .filter(({ key }) => key in form.answers)
          .map((item) => (
            <Answer key={item.key} sessionId={sessionId} form={form} item={item} />
          ))}
      </ul>
    </section>
  );
}

interface AnswerProps extends OneFormProps {
  readonly item: Item;
}

function Answer({ sessionId, form, item }: AnswerProps): JSX.Element {
  const { t, language } = useTexts();
  const [correcting, setCorrecting] = useState(false);
  const words = { leftOut: t("answers.leftOut"), yes: t("answers.yes"), no: t("answers.no") };
  const itemText = inLanguage(item.text, language);
  return (
    <li>
      <div className={classes.answer}>
        <div>
          <div className={classes.questionText}>{itemText}</div>
          <div>{answerText(form, item, form.answers[item.key] ?? null, language, words)}</div>
          {form.corrections
            .filter((one) => one.item === item.key)
            .map((one) => (
              <div key={one.at} className={classes.soft}>
                {t("answers.was", {
                  previous: answerText(form, item, one.previous, language, words),
                  date: dateTime(one.at, language),
                  by: one.by.replace("account:", ""),
                  reason: one.reason,
                })}
              </div>
            ))}
        </div>
        {!correcting && (
          <Button
            variant="subtle"
            size="compact-sm"
            aria-label={`${t("answers.correct")}: ${itemText}`}
            onClick={() => setCorrecting(true)}
          >
            {t("answers.correct")}
          </Button>
        )}
      </div>
      {correcting && (
        <CorrectAnswer
          sessionId={sessionId}
          form={form}
          item={item}
          onDone={() => setCorrecting(false)}
        />
      )}
    </li>
  );
}
