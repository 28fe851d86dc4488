/** One click: a scripted participant goes through the study while the user watches. */
import { Button } from "@mantine/core";
import { tryouts } from "@shared/api/housekeeping";
import type { StudyDetail } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { tryoutQuery } from "../queries";
import classes from "./Tour.module.css";

interface TryItProps {
  readonly study: Pick<StudyDetail, "key" | "languages" | "archived_at">;
}

/** An empty page's offer of a scripted participant, with an explanation. */
export function TryIt({ study }: TryItProps): JSX.Element | null {
  const { t, language } = useTexts();
  const can = usePermissions();
  const start = useStartTryout();
  if (!can("tryout") || study.archived_at !== null) return null;
  return (
    <div className={classes.offer}>
      <Button
        variant="light"
        loading={start.isPending}
        leftSection={<Icon name="play" size={18} />}
        onClick={() =>
          start.mutate({ studyKey: study.key, language: studyLanguage(study.languages, language) })
        }
      >
        {t("try.button")}
      </Button>
      <p>{t("try.explain")}</p>
      {start.isError && <Failure error={start.error} />}
    </div>
  );
}

/** The page's language if the study has it, otherwise the study's first. */
export const studyLanguage = (languages: readonly string[], preferred: string): string =>
  languages.includes(preferred) ? preferred : (languages[0] ?? "en");

// The scripted participant: whether one is running, starting and stopping it.

/** `enabled`: only accounts that may start one request its state. */
export function useTryout(enabled: boolean) {
  const query = useQuery({ ...tryoutQuery, enabled });
  return query.data ?? null;
}

interface TryoutRequest {
  readonly studyKey: string;
  readonly language: string;
}

export function useStartTryout() {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: ({ studyKey, language }: TryoutRequest) => tryouts.start(studyKey, language),
    onSuccess: (started) => queries.setQueryData(tryoutQuery.queryKey, started),
  });
}

export function useStopTryout() {
  const queries = useQueryClient();
  return useMutation({
    mutationFn: tryouts.stop,
    onSuccess: (stopped) => queries.setQueryData(tryoutQuery.queryKey, stopped),
  });
}
