/** The first page: what to try until people take part, the state of the lab, the studies. */
import { Button, Code, Progress, Text, Title } from "@mantine/core";
import type { LabState as LabStateData } from "@shared/api/housekeeping";
import type { StudySummary } from "@shared/api/types";
import { day } from "@shared/format";
import { inLanguage } from "@shared/text";
import { Icon } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Link } from "wouter";
import { useDemo } from "../home/demo";
import { studyProgress, whoTookPart } from "../home/demoState";
import { DemoLine, FirstSteps } from "../home/FirstSteps";
import home from "../home/Home.module.css";
import { LabState } from "../home/LabState";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { archivedQuery, labQuery, studiesQuery } from "../queries";
import { EmptyState } from "../ui/EmptyState";
import { Loaded } from "../ui/Loaded";
import { useTitle } from "../ui/page";
import classes from "./Studies.module.css";

export function StudiesPage(): JSX.Element {
  const { t } = useTexts();
  const can = usePermissions();
  const [archived, setArchived] = useState(false);
  const query = useQuery(archived ? archivedQuery : studiesQuery);
  useTitle(t("app.studies"));
  return (
    <>
      <div className={classes.head}>
        <div>
          <Title order={1}>{t("app.studies")}</Title>
          <Text c="dimmed">{t("studies.lead")}</Text>
        </div>
        <div className={classes.actions}>
          <Button variant="subtle" onClick={() => setArchived(!archived)}>
            {t(archived ? "versions.hide" : "versions.show")}
          </Button>
          {can("design") && (
            <Button component={Link} href="/new" leftSection={<Icon name="add" size={18} />}>
              {t("new.title")}
            </Button>
          )}
        </div>
      </div>
      <Loaded query={query}>
        {(studies) =>
          studies.length > 0 ? (
            <Listed studies={studies} archived={archived} />
          ) : archived ? (
            <EmptyState icon="document" title={t("versions.noneArchived")}>
              {t("versions.noneArchived.body")}
            </EmptyState>
          ) : (
            <NoStudies />
          )
        }
      </Loaded>
    </>
  );
}

interface ListedProps {
  readonly studies: readonly StudySummary[];
  readonly archived: boolean;
}

/** The state of the lab as soon as there is a session; what can be tried until people take part. */
function Listed({ studies, archived }: ListedProps): JSX.Element {
  const [since] = useState(midnight);
  const lab = useQuery({ ...labQuery(since), enabled: !archived });
  const state = lab.data;
  const tookPart = whoTookPart(studies);
  // What stands above the studies comes with them: shown later, it would push them down.
  if (!archived && lab.isPending) return <Loaded query={lab}>{() => null}</Loaded>;
  return (
    <>
      {!archived && tookPart !== "nobody" && state !== undefined && <LabState state={state} />}
      {!archived && (tookPart === "people" ? <DemoLine /> : <FirstSteps listed={studies} />)}
      <Cards studies={studies} progress={state?.studies ?? []} />
    </>
  );
}

/** The beginning of the reader's day. */
function midnight(): string {
  const now = new Date();
  return new Date(now.getFullYear(), now.getMonth(), now.getDate()).toISOString();
}

function NoStudies(): JSX.Element {
  const { t } = useTexts();
  return (
    <EmptyState icon="document" title={t("studies.empty.title")}>
      <p>{t("studies.empty.body")}</p>
      <p>
        {t("studies.empty.file")} <Code>study_configs/reembodiment-latency.yaml</Code>
      </p>
    </EmptyState>
  );
}

type StudyProgress = LabStateData["studies"][number];

interface CardsProps {
  readonly studies: readonly StudySummary[];
  readonly progress: readonly StudyProgress[];
}

function Cards({ studies, progress }: CardsProps): JSX.Element {
  return (
    <ul className={classes.cards}>
      {studies.map((study) => (
        <li key={study.key}>
          <Card
            study={study}
            progress={progress.find(({ study_key }) => study_key === study.key)}
          />
        </li>
      ))}
    </ul>
  );
}

interface CardProps {
  readonly study: StudySummary;
  readonly progress: StudyProgress | undefined;
}

function Card({ study, progress }: CardProps): JSX.Element {
  const { t, language } = useTexts();
  return (
    <Link href={`/studies/${study.key}`} className={classes.card ?? ""}>
      <div>
        <div className={classes.title}>{inLanguage(study.titles, language)}</div>
        <div className={classes.version}>
          <span>{t("study.version", { version: study.version })}</span>
          <span>
            <Icon name={study.frozen ? "lock" : "document"} size={15} />
            {t(study.frozen ? "study.frozen" : "study.open")}
          </span>
          <span>{day(study.created_at, language)}</span>
        </div>
      </div>
      <p className={classes.about}>{inLanguage(study.descriptions, language)}</p>
      <div className={`${home.progress} numbers`}>
        {progress !== undefined && <ProgressLine study={study} progress={progress} />}
      </div>
    </Link>
  );
}

interface ProgressLineProps {
  readonly study: StudySummary;
  readonly progress: StudyProgress;
}

function ProgressLine({ study, progress }: ProgressLineProps): JSX.Element {
  const { t } = useTexts();
  const demo = useDemo();
  const { of, completed, planned } = studyProgress(study, progress, demo);
  const text = t(of, { completed, planned });
  const { simulated = 0, test = 0 } = study.session_counts;
  // Of the demo lab the text says it already.
  const hasOthers = of !== "demo.finished" && simulated + test > 0;
  // Visits that were broken off are open until the demo lab is loaded again, but nobody is there.
  const isRunning = progress.running > 0 && (of !== "demo.finished" || demo?.state === "loading");
  return (
    <>
      <Progress value={planned === 0 ? 0 : (100 * completed) / planned} aria-label={text} />
      <div className={home.progressText}>
        <span>{text}</span>
        <span>
          {isRunning
            ? t("home.progress.running", { count: progress.running })
            : hasOthers && t("home.others", { simulated, test })}
        </span>
      </div>
    </>
  );
}
