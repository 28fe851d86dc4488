/** The tablet's wording of errors: written for participants, not for engineers. */
import { ErrorNotice, errorTexts } from "@shared/ui/Notice";
import type { JSX } from "react";
import { useTexts } from "./i18n";

interface FailureProps {
  readonly error: unknown;
  readonly onRetry?: () => void;
}

export function Failure({ error, onRetry }: FailureProps): JSX.Element {
  const { t } = useTexts();
  return <ErrorNotice error={error} texts={errorTexts(t)} onRetry={onRetry} />;
}
