/** The start of a new study: from a template, from an existing study, from a file, or empty. */
import { Button, Title } from "@mantine/core";
import type { Template } from "@shared/api/drafts";
import type { StudySummary } from "@shared/api/types";
import { inLanguage } from "@shared/text";
import { Icon } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import { type JSX, type ReactNode, useState } from "react";
import { Link, useLocation } from "wouter";
import { useTexts } from "../i18n";
import { studiesQuery, templatesQuery } from "../queries";
import { Loaded } from "../ui/Loaded";
import { useTitle } from "../ui/page";
import { TextFileButton } from "../ui/TextFileButton";
import { GIVEN_START, keptDraft, NEW_STUDY, storeDraft } from "./keptDraft";
import { NewDraft } from "./NewDraft";
import classes from "./NewStudy.module.css";

export function NewStudyPage(): JSX.Element {
  const { t } = useTexts();
  useTitle(t("new.title"));
  // What follows the lists is shown with them, or they would push it down.
  const studies = useQuery(studiesQuery);
  const [kept, setKept] = useState(() => keptDraft(NEW_STUDY));
  return (
    <>
      <Link href="/" className={classes.crumbs ?? ""}>
        <Icon name="back" size={16} />
        {t("app.studies")}
      </Link>
      <Title order={1}>{t("new.title")}</Title>
      <p className={classes.lead}>{t("new.lead")}</p>
      {kept !== null && <NewDraft kept={kept} instead={null} onDiscarded={() => setKept(null)} />}
      <Title order={2}>{t("new.templates")}</Title>
      <Loaded query={useQuery(templatesQuery)}>
        {(templates) => (
          <>
            <ul className={classes.cards}>
              {templates.map((template) => (
                <TemplateCard key={template.key} template={template} />
              ))}
            </ul>
            {!studies.isPending && <OtherStarts studies={studies.data ?? []} />}
          </>
        )}
      </Loaded>
    </>
  );
}

function TemplateCard({ template }: { readonly template: Template }): JSX.Element {
  const { t, language } = useTexts();
  return (
    <li>
      <Link href={`/new/template/${template.key}`} className={classes.card ?? ""}>
        <span className={classes.name}>{inLanguage(template.title, language)}</span>
        <span className={classes.about}>{inLanguage(template.description, language)}</span>
        {template.needs_feet && (
          <span className={classes.needs}>
            <Icon name="foot" size={16} />
            {t("new.feet")}
          </span>
        )}
      </Link>
    </li>
  );
}

interface StudiesProps {
  readonly studies: readonly StudySummary[];
}

function OtherStarts({ studies }: StudiesProps): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.others}>
      <FromStudy studies={studies} />
      <FromFile />
      <StartOption icon="document" title={t("new.empty")} lead={t("new.empty.lead")}>
        <Button component={Link} href="/new/empty" variant="default">
          {t("new.empty.do")}
        </Button>
      </StartOption>
    </div>
  );
}

interface StartOptionProps {
  readonly icon: "document" | "upload" | "add";
  readonly title: string;
  readonly lead: string;
  readonly children: ReactNode;
}

function StartOption({ icon, title, lead, children }: StartOptionProps): JSX.Element {
  return (
    <section className={classes.option}>
      <h2>
        <Icon name={icon} size={18} />
        {title}
      </h2>
      <p>{lead}</p>
      {children}
    </section>
  );
}

function FromStudy({ studies }: StudiesProps): JSX.Element {
  const { t, language } = useTexts();
  return (
    <StartOption icon="add" title={t("new.copy")} lead={t("new.copy.lead")}>
      <ul className={classes.list}>
        {studies.map((study) => (
          <li key={study.key}>
            <Link href={`/new/study/${study.key}`}>{inLanguage(study.titles, language)}</Link>
          </li>
        ))}
      </ul>
    </StartOption>
  );
}

function FromFile(): JSX.Element {
  const { t } = useTexts();
  const [, navigate] = useLocation();
  const open = (text: string) => {
    storeDraft(GIVEN_START, text);
    navigate("/new/given");
  };
  return (
    <StartOption icon="upload" title={t("new.import")} lead={t("new.import.lead")}>
      <TextFileButton accept=".yaml,.yml,text/yaml" onText={open} />
    </StartOption>
  );
}
