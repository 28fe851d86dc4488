/** The title of a study's page, with the study beside it, and what can be done on the page. */
import { Button, Title } from "@mantine/core";
import type { StudyDetail } from "@shared/api/types";
import { inLanguage } from "@shared/text";
import { Icon } from "@shared/ui/Icon";
import { type JSX, type ReactNode, useState } from "react";
import { Link } from "wouter";
import type { SECTIONS } from "../../frame/places";
import { useTexts } from "../../i18n";
import { usePermissions } from "../../permissions";
import { useTitle } from "../../ui/page";
import { NewSession } from "./NewSession";
import classes from "./StudyPage.module.css";

export type StudySection = (typeof SECTIONS)[number];

interface StudyHeadProps {
  readonly study: StudyDetail;
  readonly section: StudySection;
  /** Choices that stand in the same row, where the page needs its height for something else. */
  readonly children?: ReactNode;
}

/** The overview is titled with the study, every other page with its own name and the study. */
export function StudyHead({ study, section, children }: StudyHeadProps): JSX.Element {
  const { t, language } = useTexts();
  const can = usePermissions();
  const title = inLanguage(study.titles, language);
  const isOverview = section.section === "overview";
  useTitle(isOverview ? title : `${t(section.name)} · ${title}`);
  return (
    <div className={children === undefined ? classes.head : `${classes.head} ${classes.withTools}`}>
      <div className={classes.names}>
        <Title order={1}>{isOverview ? title : t(section.name)}</Title>
        {!isOverview && (
          <Link
            href={`/studies/${study.key}/overview`}
            className={classes.crumbs ?? ""}
            title={title}
          >
            {title}
          </Link>
        )}
        {isOverview && (
          <div className={classes.meta}>
            <span>{study.key}</span>
            <span>{t("study.version", { version: study.version })}</span>
            <span>
              <Icon name={study.frozen ? "lock" : "document"} size={15} />
              {t(study.frozen ? "study.frozenLong" : "study.openLong")}
            </span>
          </div>
        )}
      </div>
      {children !== undefined && <div className={classes.tools}>{children}</div>}
      {can("run") && section.group === "run" && <NewSessionButton study={study} />}
    </div>
  );
}

function NewSessionButton({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  const [joining, setJoining] = useState(false);
  return (
    <>
      <Button
        leftSection={<Icon name="add" size={18} />}
        disabled={study.archived_at !== null}
        onClick={() => setJoining(true)}
      >
        {t("join.open")}
      </Button>
      <NewSession study={study} opened={joining} onClose={() => setJoining(false)} />
    </>
  );
}
