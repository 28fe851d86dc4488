/** Problems of a configuration file: where, what, and what to write instead. */
import type { Problem } from "@shared/api/errors";
import { Notice } from "@shared/ui/Notice";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./ImportDialog.module.css";
import { place } from "./problemPlace";

interface ProblemsProps {
  readonly problems: readonly Problem[];
  readonly onPick: (line: number) => void;
}

export function Problems({ problems, onPick }: ProblemsProps): JSX.Element {
  const { t } = useTexts();
  return (
    <Notice tone="bad" title={t("import.problems", { count: problems.length })}>
      <ul className={classes.problems}>
        {problems.map((problem) => (
          <li key={`${place(problem)} ${problem.message}`}>
            <button
              type="button"
              className={classes.problem}
              onClick={() => onPick(problem.line ?? 1)}
            >
              <span className={classes.place}>{place(problem)}</span>
              <span>{problem.message}</span>
              {problem.remedy != null && <span className={classes.remedy}>{problem.remedy}</span>}
            </button>
          </li>
        ))}
      </ul>
    </Notice>
  );
}
