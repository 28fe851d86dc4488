/** Problems of a configuration file: where, what, and what to write instead. */
import type { Problem } from "@shared/api/request";
import { Notice } from "@shared/ui/Notice";
import type { JSX } from "react";
import { useTexts } from "../i18n";
import classes from "./ImportDialog.module.css";

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

/** `orders.replicates:12:15`: path, line and column as compilers write them. */
export function place(problem: Problem): string {
  return [problem.path, problem.line, problem.column]
    .filter((part) => part !== null && part !== undefined && part !== "")
    .join(":");
}

/** Where a line (counted from 1) starts and ends in a text. */
export function offsetOfLine(text: string, line: number): readonly [number, number] {
  const lines = text.split("\n");
  const start = lines.slice(0, line - 1).reduce((sum, part) => sum + part.length + 1, 0);
  return [start, start + (lines[line - 1]?.length ?? 0)];
}
