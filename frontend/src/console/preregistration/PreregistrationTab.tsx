/** The study's preregistration, its analysis, and every way in which they differ. */
import { Button, Group, Paper, Title } from "@mantine/core";
import { type Deviation, type Preregistration, preregistrations } from "@shared/api/analysis";
import type { StudyDetail } from "@shared/api/types";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link } from "wouter";
import { useTexts } from "../i18n";
import page from "../pages/study/StudyPage.module.css";
import { usePermissions } from "../permissions";
import { preregistrationQuery } from "../queries";
import { useKind } from "../ui/chosenKind";
import { EmptyState } from "../ui/EmptyState";
import { KindFilter } from "../ui/KindFilter";
import { Loaded } from "../ui/Loaded";
import { AnalysisCard } from "./AnalysisCard";
import { DeclarationCard } from "./DeclarationCard";
import classes from "./Preregistration.module.css";

export function PreregistrationTab({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  const [kind, setKind] = useKind(study.key);
  const query = useQuery(preregistrationQuery(study.key, kind));
  return (
    <>
      <div className={page.toolbar}>
        <KindFilter kind={kind} onChange={setKind} />
        <Group className={page.spacer ?? ""} gap="xs">
          {(["markdown", "json"] as const).map((form) => (
            <Button
              key={form}
              component="a"
              variant="default"
              href={preregistrations.reportUrl(study.key, kind, form)}
              leftSection={<Icon name="download" size={17} />}
            >
              {t(`prereg.${form}`)}
            </Button>
          ))}
        </Group>
      </div>
      <Loaded query={query}>{(view) => <Page study={study} view={view} />}</Loaded>
    </>
  );
}

interface PageProps {
  readonly study: StudyDetail;
  readonly view: Preregistration;
}

function Page({ study, view }: PageProps): JSX.Element {
  const { t } = useTexts();
  const { declaration } = view;
  if (declaration === null) return <NotPreregistered study={study} />;
  return (
    <div className={classes.page}>
      {view.simulated && (
        <Notice tone="sim" title={t("simulated.title")}>
          {t("simulated.body")}
        </Notice>
      )}
      <div className={classes.both}>
        <DeclarationCard declaration={declaration} />
        <AnalysisCard view={view} alpha={declaration.alpha} />
      </div>
      <Deviations deviations={view.deviations} />
    </div>
  );
}

function NotPreregistered({ study }: { readonly study: StudyDetail }): JSX.Element {
  const { t } = useTexts();
  const can = usePermissions();
  return (
    <EmptyState
      icon="lock"
      title={t("prereg.none")}
      action={
        can("design") && (
          <Button component={Link} href={`/studies/${study.key}/edit`}>
            {t("prereg.none.do")}
          </Button>
        )
      }
    >
      {t("prereg.none.body")}
    </EmptyState>
  );
}

/** How the analysis differs from its declaration, and what else a reader has to know. */
export function Deviations({
  deviations,
}: {
  readonly deviations: readonly Deviation[];
}): JSX.Element {
  const { t } = useTexts();
  const real = deviations.filter(({ is_note }) => !is_note);
  const notes = deviations.filter(({ is_note }) => is_note);
  return (
    <Paper>
      <Title order={2} size="h3">
        {t("prereg.deviations")}
      </Title>
      {real.length === 0 ? (
        <p className={classes.fine}>
          <Icon name="check" size={18} /> {t("prereg.deviations.none")}
        </p>
      ) : (
        <ul className={classes.list}>
          {real.map((one) => (
            <DeviationText key={one.text} deviation={one} />
          ))}
        </ul>
      )}
      <h3 className={classes.small}>{t("prereg.notes")}</h3>
      <ul className={classes.list}>
        {notes.map((one) => (
          <DeviationText key={one.text} deviation={one} />
        ))}
      </ul>
    </Paper>
  );
}

function DeviationText({ deviation }: { readonly deviation: Deviation }): JSX.Element {
  const { t } = useTexts();
  return (
    <li className={deviation.is_note ? classes.note : classes.deviation}>
      <Icon name={deviation.is_note ? "info" : "alert"} size={18} />
      <div>
        <strong>{t(`prereg.code.${deviation.code}`)}</strong>
        <p>{deviation.text}</p>
      </div>
    </li>
  );
}

/** The query of a study's preregistration, with its cache key. */
