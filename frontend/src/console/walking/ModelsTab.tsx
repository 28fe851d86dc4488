/** The models, and the sets of walks on which they are fitted. */
import { Button, Title } from "@mantine/core";
import { Icon } from "@shared/ui/Icon";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useState } from "react";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { EmptyState } from "../ui/EmptyState";
import { Loaded } from "../ui/Loaded";
import { ModelTable } from "./ModelTable";
import { NewModel } from "./NewModel";
import { NewWalks } from "./NewWalks";
import { modelsQuery, walkSetsQuery } from "./queries";
import classes from "./Walking.module.css";
import { WalkSetTable } from "./WalkSetTable";

export function ModelsTab(): JSX.Element {
  const { t } = useTexts();
  const canWrite = usePermissions()("walking");
  const [adding, setAdding] = useState<"model" | "walks" | null>(null);
  const sets = useQuery(walkSetsQuery);
  const done = () => setAdding(null);
  return (
    <>
      <div className={classes.section}>
        <div>
          <Title order={2}>{t("walking.models")}</Title>
          <p className={classes.soft}>{t("walking.models.lead")}</p>
        </div>
        {canWrite && (
          <Button
            leftSection={<Icon name="add" size={18} />}
            disabled={(sets.data ?? []).length === 0}
            onClick={() => setAdding("model")}
          >
            {t("walking.model.new")}
          </Button>
        )}
      </div>
      <Loaded query={useQuery(modelsQuery)}>
        {(models) =>
          models.length === 0 ? (
            <EmptyState icon="chart" title={t("walking.models.none")}>
              {t("walking.models.none.body")}
            </EmptyState>
          ) : (
            <ModelTable models={models} />
          )
        }
      </Loaded>
      <div className={classes.section}>
        <div>
          <Title order={2}>{t("walking.sets")}</Title>
          <p className={classes.soft}>{t("walking.sets.lead")}</p>
        </div>
        {canWrite && (
          <Button
            variant="default"
            leftSection={<Icon name="add" size={18} />}
            onClick={() => setAdding("walks")}
          >
            {t("walking.sets.new")}
          </Button>
        )}
      </div>
      <Loaded query={sets}>
        {(all) =>
          all.length === 0 ? (
            <EmptyState icon="walk" title={t("walking.sets.none")}>
              {t("walking.sets.none.body")}
            </EmptyState>
          ) : (
            <WalkSetTable sets={all} />
          )
        }
      </Loaded>
      <NewModel opened={adding === "model"} sets={sets.data ?? []} onClose={done} />
      <NewWalks opened={adding === "walks"} onClose={done} />
    </>
  );
}
