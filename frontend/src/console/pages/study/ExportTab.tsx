/** Tidy CSV for analysis: the contents of the archive, and its download. */
import { Button, Paper, Stack, Text, Title } from "@mantine/core";
import type { StudyDetail } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { DownloadList } from "../../downloads/DownloadCard";
import { useExports, useOrder } from "../../downloads/useExports";
import { Failure } from "../../errors";
import { useTexts } from "../../i18n";
import { ImportsCard } from "../../imports/ImportsCard";
import { codebookQuery } from "../../queries";
import { useKind } from "../../ui/chosenKind";
import { KindFilter } from "../../ui/KindFilter";
import { Loaded } from "../../ui/Loaded";
import { filesOf } from "./archiveFiles";
import { CodebookTable } from "./CodebookTable";
import classes from "./ExportTab.module.css";

export function ExportTab({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.grid}>
      <Download study={study} />
      <ImportsCard study={study} />
      <Paper className={classes.wide ?? ""}>
        <Title order={2} mb="md">
          {t("export.files")}
        </Title>
        <dl className={classes.files}>
          {filesOf(study).map((file) => (
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
      <Codebook study={study} />
    </div>
  );
}

function Download({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  const [kind, setKind] = useKind(study.key);
  const order = useOrder();
  return (
    <Paper>
      <Title order={2} mb="md">
        {t("export.download")}
      </Title>
      <Stack>
        <KindFilter kind={kind} onChange={setKind} />
        {kind === "simulated" && <Notice tone="sim">{t("simulated.body")}</Notice>}
        <Button
          leftSection={<Icon name="download" size={18} />}
          loading={order.isPending}
          onClick={() => order.mutate({ studyKey: study.key, kind, movement: false })}
        >
          {t("export.start")}
        </Button>
        <Text size="sm" c="dimmed">
          {t("export.tables.about")}
        </Text>
        <Button
          variant="default"
          leftSection={<Icon name="walk" size={18} />}
          loading={order.isPending}
          onClick={() => order.mutate({ studyKey: study.key, kind })}
        >
          {t("export.movement")}
        </Button>
        <Text size="sm" c="dimmed">
          {t("export.movement.about")}
        </Text>
        {order.isError && <Failure error={order.error} />}
        <DownloadList query={useExports(true)} studyKey={study.key} />
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
