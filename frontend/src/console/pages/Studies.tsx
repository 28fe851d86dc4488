import { Button, Code, Text, Title } from "@mantine/core";
import type { StudySummary } from "@shared/api/types";
import { day } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { Link } from "wouter";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { archivedQuery, studiesQuery } from "../queries";
import { EmptyState } from "../ui/EmptyState";
import { KINDS } from "../ui/KindFilter";
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
            <Cards studies={studies} />
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

function Cards({ studies }: { readonly studies: readonly StudySummary[] }): JSX.Element {
  return (
    <ul className={classes.cards}>
      {studies.map((study) => (
        <li key={study.key}>
          <Card study={study} />
        </li>
      ))}
    </ul>
  );
}

function Card({ study }: { readonly study: StudySummary }): JSX.Element {
  const { t, language } = useTexts();
  return (
    <Link href={`/studies/${study.key}`} className={classes.card ?? ""}>
      <div>
        <div className={classes.title}>{study.title}</div>
        <div className={classes.version}>
          <span>{t("study.version", { version: study.version })}</span>
          <span>
            <Icon name={study.frozen ? "lock" : "document"} size={15} />
            {t(study.frozen ? "study.frozen" : "study.open")}
          </span>
          <span>{day(study.created_at, language)}</span>
        </div>
      </div>
      <p className={classes.about}>{study.description}</p>
      <dl className={`${classes.counts} numbers`}>
        {KINDS.map((kind) => (
          <div key={kind}>
            <dt>{t(`kind.${kind}`)}</dt>
            <dd>{study.session_counts[kind] ?? 0}</dd>
          </div>
        ))}
      </dl>
    </Link>
  );
}
