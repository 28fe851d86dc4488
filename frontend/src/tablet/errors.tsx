/** The tablet's wording of errors: written for participants, not for engineers. */
import { ErrorNotice, type ErrorTexts } from "@shared/ui/Notice";
import type { JSX } from "react";
import { useTexts } from "./i18n";

interface FailureProps {
  readonly error: unknown;
  readonly onRetry?: () => void;
}

export function Failure({ error, onRetry }: FailureProps): JSX.Element {
  const { t } = useTexts();
  const texts: ErrorTexts = {
    unreachable: t("error.unreachable"),
    unreachableRemedy: t("error.unreachableRemedy"),
    unexpected: t("error.unexpected"),
    retry: t("error.retry"),
  };
  return <ErrorNotice error={error} texts={texts} onRetry={onRetry} />;
}
