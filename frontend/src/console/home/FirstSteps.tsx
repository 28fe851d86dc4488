/** What a newcomer can do in one click, before people have taken part. */
import { Button, Title } from "@mantine/core";
import { studies } from "@shared/api/endpoints";
import type { Demo } from "@shared/api/housekeeping";
import type { StudySummary } from "@shared/api/types";
import { inLanguage } from "@shared/text";
import { Icon, type IconName } from "@shared/ui/Icon";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link, useLocation } from "wouter";
import { Failure } from "../errors";
import { lastStudy } from "../frame/currentStudy";
import { type Key, useTexts } from "../i18n";
import { type Permission, usePermissions } from "../permissions";
import { studyQuery } from "../queries";
import { opened, useActOnScreen } from "../tour/onScreen";
import { studyToTry } from "../tour/studyToTry";
import { studyLanguage, useStartTryout } from "../tour/TryIt";
import { DemoProgress, DemoStatus, LoadRest, RemoveDemo } from "./DemoControls";
import { FIGURES, useDemo, useLoadDemo } from "./demo";
import { isThere, whoTookPart } from "./demoState";
import classes from "./Home.module.css";

export function FirstSteps({ listed }: { readonly listed: readonly StudySummary[] }): JSX.Element {
  const { t, language } = useTexts();
  const [, navigate] = useLocation();
  const queries = useQueryClient();
  const demo = useDemo();
  const load = useLoadDemo();
  const start = useStartTryout();
  const act = useActOnScreen();
  const study = studyToTry("/", listed, lastStudy());
  const watch = useMutation({
    mutationFn: async (studyKey: string) => {
      const found = await queries.fetchQuery({
        ...studyQuery(studyKey),
        queryFn: () => studies.get(studyKey),
      });
      return start.mutateAsync({ studyKey, language: studyLanguage(found.languages, language) });
    },
  });
  return (
    <section aria-labelledby="first-steps">
      <Title order={2} id="first-steps">
        {t("home.first")}
      </Title>
      <p className={classes.lead}>
        {t(whoTookPart(listed) === "nobody" ? "home.first.lead.nobody" : "home.first.lead.others")}
      </p>
      <div className={classes.steps}>
        {isThere(demo) ? (
          <DemoStep demo={demo} />
        ) : (
          <Step
            step="home.demo"
            icon="chart"
            permission="demo"
            isFirst
            isBusy={load.isPending}
            error={load.error}
            onChoose={() => load.mutate()}
          />
        )}
        <Step
          step="home.watch"
          icon="play"
          permission="tryout"
          isBusy={watch.isPending}
          error={watch.error}
          study={study}
          onChoose={study === null ? undefined : () => watch.mutate(study.key)}
        />
        <Step
          step="home.act"
          icon="headset"
          permission="run"
          isBusy={act.isPending}
          error={act.error}
          study={study}
          onChoose={
            study === null ? undefined : () => act.mutate({ studyKey: study.key, tab: opened() })
          }
        />
        <Step
          step="home.create"
          icon="add"
          permission="design"
          isBusy={false}
          error={null}
          onChoose={() => navigate("/new")}
        />
      </div>
    </section>
  );
}

/** The demo lab once it has been loaded, or is being loaded: how far it is, and its figures. */
function DemoStep({ demo }: { readonly demo: Demo }): JSX.Element {
  const { t } = useTexts();
  return (
    <section className={classes.step} aria-label={t("demo.label")}>
      <div className={classes.demo}>
        <Title order={3} className={classes.stepTitle ?? ""}>
          {t("demo.title")}
        </Title>
        <DemoStatus demo={demo} all={t("demo.all", { planned: demo.people })} />
        <DemoProgress demo={demo} />
        <span className={classes.demoButtons}>
          <LoadRest demo={demo} />
          <RemoveDemo />
        </span>
      </div>
      <Button
        component={Link}
        href={FIGURES}
        classNames={WRAPPED}
        leftSection={<Icon name="chart" size={18} />}
      >
        {t("demo.results")}
      </Button>
    </section>
  );
}

/** The demo lab in one line, where the lab has sessions of people. */
export function DemoLine(): JSX.Element | null {
  const { t } = useTexts();
  const demo = useDemo();
  if (!isThere(demo)) return null;
  return (
    <section className={classes.demoLine} aria-label={t("demo.label")}>
      <Icon name="body" size={17} />
      <strong>{t("demo.title")}</strong>
      <DemoStatus demo={demo} all={t("demo.all", { planned: demo.people })} />
      <DemoProgress demo={demo} />
      <span className={classes.stripButtons}>
        <LoadRest demo={demo} />
        <Button component={Link} href={FIGURES} size="compact-xs" variant="default">
          {t("demo.results")}
        </Button>
        <RemoveDemo />
      </span>
    </section>
  );
}

/** In a narrow card the words of a button take two lines. */
const WRAPPED = { root: classes.button ?? "", label: classes.buttonLabel ?? "" };

interface StepProps {
  readonly step: "home.demo" | "home.watch" | "home.act" | "home.create";
  readonly icon: IconName;
  readonly permission: Permission;
  readonly isFirst?: boolean;
  readonly isBusy: boolean;
  readonly error: Error | null;
  /** The study that it is done with. */
  readonly study?: StudySummary | null;
  /** Missing where there is no study to do it with. */
  readonly onChoose: (() => void) | undefined;
}

function Step(props: StepProps): JSX.Element | null {
  const { step, icon, permission, isFirst = false, isBusy, error, study, onChoose } = props;
  const { t, language } = useTexts();
  const can = usePermissions();
  if (!can(permission)) return null;
  const body: Key = `${step}.body`;
  return (
    <section className={classes.step} aria-labelledby={`${step}.title`}>
      <Title order={3} id={`${step}.title`} className={classes.stepTitle ?? ""}>
        {t(`${step}.title`)}
      </Title>
      <p>{t(body)}</p>
      {study != null && (
        <span className={classes.stepStudy}>
          {t("home.step.study", { title: inLanguage(study.titles, language) })}
        </span>
      )}
      {error !== null && <Failure error={error} />}
      <Button
        variant={isFirst ? "filled" : "light"}
        loading={isBusy}
        disabled={onChoose === undefined}
        classNames={WRAPPED}
        leftSection={<Icon name={icon} size={18} />}
        onClick={onChoose}
      >
        {t(step)}
      </Button>
    </section>
  );
}
