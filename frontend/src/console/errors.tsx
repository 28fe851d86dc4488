/** The console's wording of errors, and a notice that uses it. */
import { ErrorNotice, type ErrorTexts, errorTexts } from "@shared/ui/Notice";
import type { JSX } from "react";
import { useTexts } from "./i18n";

export function useErrorTexts(): ErrorTexts {
  const { t } = useTexts();
  const files = {
    line: t("error.line"),
    changed: (name: string) => t("error.fileChanged", { name }),
    changedRemedy: t("error.fileChangedRemedy"),
  };
  return { ...errorTexts(t), files };
}

interface FailureProps {
  readonly error: unknown;
  readonly onRetry?: () => void;
}

export function Failure({ error, onRetry }: FailureProps): JSX.Element {
  return <ErrorNotice error={error} texts={useErrorTexts()} onRetry={onRetry} />;
}
