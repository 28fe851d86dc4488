/** Scores of the questionnaires as they arrive, newest first. */
import { Button } from "@mantine/core";
import { useDisclosure } from "@mantine/hooks";
import type { AdministrationScores, Score, SessionView } from "@shared/api/types";
import { latency, number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { milliseconds } from "@shared/units";
import type { JSX } from "react";
import { useTexts } from "../../i18n";
import { usePermissions } from "../../permissions";
import { AnswersDrawer } from "../../rights/AnswersDrawer";
import { isCounted, stepName } from "../../steps";
import cockpit from "../Cockpit.module.css";
import classes from "../Panels.module.css";
import answerHintsClasses from "./AnswerHints.module.css";

export function ScoresPanel({ session }: { readonly session: SessionView }): JSX.Element {
  const { t } = useTexts();
  const can = usePermissions();
  const [opened, { open, close }] = useDisclosure();
  const scored = session.scores.filter(
    ({ score_views, hints }) => score_views.length > 0 || hints.length > 0,
  );
  return (
    <section>
      <div className={classes.titleRow}>
        <h2 className={cockpit.sectionTitle}>{t("scores.title")}</h2>
        {can("rights") && (
          <Button variant="subtle" size="compact-sm" onClick={open}>
            {t("answers.open")}
          </Button>
        )}
      </div>
      <AnswersDrawer
        sessionId={session.id}
        code={session.participant_code}
        opened={opened}
        onClose={close}
      />
      {scored.length === 0 ? (
        <p className={classes.empty}>{t("scores.empty")}</p>
      ) : (
        <div className={classes.scores}>
          {[...scored].reverse().map((one) => (
            <Scores key={one.administration} session={session} one={one} />
          ))}
        </div>
      )}
    </section>
  );
}

interface ScoresProps {
  readonly session: SessionView;
  readonly one: AdministrationScores;
}

function Scores({ session, one }: ScoresProps): JSX.Element {
  const { t, language } = useTexts();
  return (
    <div>
      <div className={classes.scoreTitle}>{whereOf(session, one, t)}</div>
      <dl className={`${classes.score} numbers`}>
        {one.score_views.map((score) => (
          <div key={score.key} style={{ display: "contents" }}>
            <dt>{score.label}</dt>
            <dd>{score.value === null ? t("scores.incomplete") : number(score.value, language)}</dd>
            <Range score={score} />
          </div>
        ))}
      </dl>
      <AnswerHints hints={one.hints} />
    </div>
  );
}

/** Which phase the answers are about: the task before the questionnaire, and its condition. */
function whereOf(
  session: SessionView,
  one: AdministrationScores,
  t: ReturnType<typeof useTexts>["t"],
): string {
  const step = session.steps[one.step_index];
  if (step === undefined) return one.instrument;
  const task = session.steps
    .slice(0, one.step_index)
    .findLast((before) => isCounted(before) && before.block === step.block);
  const name = task === undefined || step.block === null ? t(stepName(step)) : t(stepName(task));
  return step.latency_ms === null ? name : `${name} · ${latency(milliseconds(step.latency_ms))}`;
}

/** The score as a mark between the lowest and the highest possible value, if those are defined. */
function Range({ score }: { readonly score: Score }): JSX.Element | null {
  const { t, language } = useTexts();
  const { minimum, maximum, value } = score;
  if (minimum === null || maximum === null || maximum <= minimum) return null;
  const ends = { low: number(minimum, language), high: number(maximum, language) };
  const share = value === null ? null : (value - minimum) / (maximum - minimum);
  return (
    <dd className={classes.range}>
      <span aria-hidden="true">{ends.low}</span>
      <span className={classes.rangeLine} title={t("scores.range", ends)}>
        {minimum < 0 && maximum > 0 && (
          <span
            className={classes.rangeZero}
            style={{ insetInlineStart: `${(-100 * minimum) / (maximum - minimum)}%` }}
          />
        )}
        {share !== null && (
          <span className={classes.rangeMark} style={{ insetInlineStart: `${100 * share}%` }} />
        )}
      </span>
      <span aria-hidden="true">{ends.high}</span>
      <span className="visually-hidden">{t("scores.range", ends)}</span>
    </dd>
  );
}

type Hint = AdministrationScores["hints"][number];

/** Remarks on how a form was filled in: unobtrusive lines below its scores. */
function AnswerHints({ hints }: { readonly hints: readonly Hint[] }): JSX.Element | null {
  const { t, language } = useTexts();
  if (hints.length === 0) return null;
  const words = ({ kind, items, value, seconds }: Hint) => {
    switch (kind) {
      case "alike":
        return t("hint.alike", { items, value: number(value ?? 0, language) });
      case "fast":
        return t("hint.fast", { items, seconds: number(seconds ?? 0, language) });
      case "left_out":
        return t("hint.left_out", { count: items });
    }
  };
  return (
    <ul className={answerHintsClasses.hints} title={t("hint.about")}>
      {hints.map((hint, place) => (
        // biome-ignore lint/suspicious/noArrayIndexKey: hints have no identifier other than their position
        <li key={place}>
          <Icon name="info" size={16} />
          <span>{words(hint)}</span>
        </li>
      ))}
    </ul>
  );
}
