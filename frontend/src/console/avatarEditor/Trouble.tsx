/** Why the last edit was not made, or a file not read: in view wherever the page is scrolled. */
import { Button } from "@mantine/core";
import { isApiError, type Problem } from "@shared/api/request";
import { AXES } from "@shared/avatar/anatomy.generated";
import { describe, Notice } from "@shared/ui/Notice";
import type { JSX } from "react";
import { axisName } from "../avatarChanges/axes";
import { useErrorTexts } from "../errors";
import { type Key, useTexts } from "../i18n";
import { FIELDS, type Field } from "./axes";
import classes from "./Editor.module.css";
import type { EditProblem, Work } from "./useWork";

const AXIS_NAMES: ReadonlySet<string> = new Set(AXES.map(({ name }) => name));

interface TroubleProps {
  readonly work: Work;
  /** The message goes, and with it the button that has the focus. */
  readonly onUnderstood: () => void;
}

export function Trouble({ work, onUnderstood }: TroubleProps): JSX.Element | null {
  const words = useTexts();
  const { t } = words;
  const texts = useErrorTexts();
  const [problem] = work.problems;
  if (work.error === null && problem === undefined) return null;
  const failure = work.error === null ? null : describe(work.error, texts);
  const details = isApiError(work.error) ? work.error.details : [];
  return (
    <div className={classes.trouble}>
      <Notice
        tone="bad"
        title={failure?.message ?? named(problem?.message ?? "", problem?.path, words)}
        remedy={failure === null ? remedyOf(problem, t) : details.length === 0 && failure.remedy}
        actions={
          <Button
            size="xs"
            variant="default"
            onClick={() => {
              onUnderstood();
              work.dismiss();
            }}
          >
            {t("action.understood")}
          </Button>
        }
      >
        {details.length > 0 && (
          <ul className={classes.problems}>
            {details.map((one) => (
              <li key={`${one.path} ${one.message}`}>{inWords(one, t)}</li>
            ))}
          </ul>
        )}
        {t("avatars.notMade")}
      </Notice>
    </div>
  );
}

type Texts = ReturnType<typeof useTexts>;

/** A message with the axis that it is about, as the table calls it. */
function named(message: string, path: string | undefined, texts: Texts): string {
  const axis = path?.split(".").find((one) => AXIS_NAMES.has(one));
  return axis === undefined ? message : `${axisName(texts, axis)}: ${message}`;
}

/** What can be given, where it is a range, and what to do. */
function remedyOf(problem: EditProblem | undefined, t: Texts["t"]): string {
  const { valid, remedy = "" } = problem ?? {};
  return typeof valid === "string"
    ? `${t("avatars.possible", { valid: valid.replace(/-(?=\d)/g, "−") })} ${remedy}`
    : remedy;
}

/** The place of a problem, as the page calls it where it has a word for it. */
function inWords({ path, message, remedy }: Problem, t: Texts["t"]): string {
  const last = path?.split(".").at(-1) ?? "";
  const known = FIELDS.includes(last as Field)
    ? t(`avatars.field.${last as Field}`)
    : last === "total_mass_kg"
      ? t("avatars.key.total_mass_kg" as Key)
      : path;
  return [known ? `${known}: ${message}` : message, remedy ?? ""].join(" ").trim();
}
