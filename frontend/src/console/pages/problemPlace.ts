/** Where a problem of a file is, for people and for the text field. */
import type { Problem } from "@shared/api/errors";

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
