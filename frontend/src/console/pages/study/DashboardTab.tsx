/** The study's figures, drawn by the server from the sessions of one kind. */

import { Figure } from "@charts/Figure";
import { Title } from "@mantine/core";
import type { Dashboard, DataKind, StudyDetail } from "@shared/api/types";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { useTexts } from "../../i18n";
import { dashboardQuery } from "../../queries";
import { EmptyState } from "../../ui/EmptyState";
import { KindFilter } from "../../ui/KindFilter";
import { Loaded } from "../../ui/Loaded";
import classes from "./DashboardTab.module.css";
import page from "./StudyPage.module.css";

export function DashboardTab({ study }: { readonly study: StudyDetail }): JSX.Element {
  const [kind, setKind] = useState<DataKind>("people");
  const { t } = useTexts();
  const query = useQuery(dashboardQuery(study.key, kind));
  return (
    <>
      <div className={page.toolbar}>
        <KindFilter kind={kind} onChange={setKind} />
        {query.data !== undefined && (
          <span className={page.push}>
            {t("dashboard.sessions", { count: query.data.n_completed })}
            {!query.data.current && ` · ${t("dashboard.drawing")}`}
          </span>
        )}
      </div>
      <Loaded query={query}>{(dashboard) => <Figures dashboard={dashboard} />}</Loaded>
    </>
  );
}

function Figures({ dashboard }: { readonly dashboard: Dashboard }): JSX.Element {
  const { t } = useTexts();
  return (
    <>
      {dashboard.simulated && (
        <div className={classes.banner}>
          <Notice tone="sim" title={t("simulated.title")}>
            {t("simulated.body")}
          </Notice>
        </div>
      )}
      {dashboard.figures.length === 0 ? (
        <EmptyState icon="chart" title={t("dashboard.empty.title")}>
          {t("dashboard.empty.body")}
        </EmptyState>
      ) : (
        <div className={classes.figures}>
          {dashboard.figures.map((figure) => (
            <figure key={figure.key} className={classes.figure}>
              <Title order={2} size="h3">
                {figure.title}
              </Title>
              {figure.figure === null ? (
                <p className={classes.missing}>{figure.empty ?? t("dashboard.empty.body")}</p>
              ) : (
                <Figure
                  figure={figure.figure}
                  label={figure.title}
                  watermark={dashboard.simulated ? t("simulated.watermark") : null}
                  loading={t("dashboard.loading")}
                  failed={t("dashboard.failed")}
                />
              )}
              <figcaption className={classes.caption}>{figure.caption}</figcaption>
            </figure>
          ))}
        </div>
      )}
    </>
  );
}
