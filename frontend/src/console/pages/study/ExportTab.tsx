/** Tidy CSV for analysis: what is in the archive, and the archive. */
import { Button, Group, Paper, Progress, Stack, Text, Title } from "@mantine/core";
import { studies } from "@shared/api/endpoints";
import type { DataKind, StudyDetail } from "@shared/api/types";
import { number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { codebookQuery } from "../../queries";
import { KindFilter } from "../../ui/KindFilter";
import { Loaded } from "../../ui/Loaded";
import { CodebookTable } from "./CodebookTable";
import classes from "./ExportTab.module.css";
import { useDownload } from "./useDownload";

const FILES = [
  "sessions",
  "phases",
  "answers",
  "scores",
  "corrections",
  "completions",
  "contacts",
  "jointErrors",
  "events",
  "quality",
  "alarms",
  "clocks",
  "samples",
  "receipts",
  "codebook",
] as const;

export function ExportTab({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.grid}>
      <Paper>
        <Title order={2} mb="md">
          {t("export.files")}
        </Title>
        <dl className={classes.files}>
          {FILES.map((file) => (
            <div key={file}>
              <dt>{t(`export.file.${file}`)}</dt>
              <dd>{t(`export.about.${file}`)}</dd>
            </div>
          ))}
        </dl>
        <Text mt="lg" c="dimmed">
          {t("export.conventions")}
        </Text>
      </Paper>
      <Download study={study} />
      <Codebook study={study} />
    </div>
  );
}

function Download({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t, language } = useTexts();
  const [kind, setKind] = useState<DataKind>("people");
  const { state, start, stop } = useDownload();
  const megabytes = (bytes: number): string => `${number(bytes / 1e6, language, 1)} MB`;
  return (
    <Paper>
      <Title order={2} mb="md">
        {t("export.download")}
      </Title>
      <Stack>
        <KindFilter kind={kind} onChange={setKind} />
        {kind === "simulated" && <Notice tone="sim">{t("simulated.body")}</Notice>}
        {state.phase === "running" ? (
          <>
            <Progress
              value={state.total === null ? 100 : (state.received / state.total) * 100}
              animated={state.total === null}
              aria-label={t("export.progress")}
            />
            <Group justify="space-between">
              <Text className="numbers">
                {state.received === 0 ? t("export.preparing") : megabytes(state.received)}
              </Text>
              <Button variant="default" size="xs" onClick={stop}>
                {t("action.stop")}
              </Button>
            </Group>
          </>
        ) : (
          <Button
            leftSection={<Icon name="download" size={18} />}
            onClick={() =>
              void start(studies.exportUrl(study.key, kind), `${study.key}-${kind}.zip`)
            }
          >
            {t("export.start")}
          </Button>
        )}
        {state.phase === "done" && (
          <Notice tone="info" icon="check" title={t("export.done")}>
            {t("export.doneBody", { name: state.name, size: megabytes(state.received) })}
          </Notice>
        )}
        {state.phase === "failed" && <Failure error={state.error} />}
      </Stack>
    </Paper>
  );
}

function Codebook({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  return (
    <Paper className={classes.wide ?? ""}>
      <Title order={2}>{t("export.codebook")}</Title>
      <Text c="dimmed" mb="md">
        {t("export.codebookLead")}
      </Text>
      <Loaded query={useQuery(codebookQuery(study.key))}>
        {(columns) => <CodebookTable columns={columns} />}
      </Loaded>
    </Paper>
  );
}
