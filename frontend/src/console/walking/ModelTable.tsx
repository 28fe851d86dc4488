/** The list of models: state, progress, and the actions for each. */
import { Button, Progress, Table } from "@mantine/core";
import { type ModelListed, walking } from "@shared/api/walking";
import { number } from "@shared/format";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link } from "wouter";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { DeleteButton } from "./DeleteButton";
import { modelsQuery } from "./queries";
import classes from "./Walking.module.css";
import { CreatedCell, Synthetic, WalkingTable } from "./WalkingTable";

const COLUMNS = ["title", "state", "on", "by"] as const;

export function ModelTable({ models }: { readonly models: readonly ModelListed[] }): JSX.Element {
  return (
    <WalkingTable columns={COLUMNS}>
      {models.map((model) => (
        <Row key={model.id} model={model} />
      ))}
    </WalkingTable>
  );
}

function Row({ model }: { readonly model: ModelListed }): JSX.Element {
  const { t, language } = useTexts();
  return (
    <Table.Tr>
      <Table.Td>
        <Link href={`/walking/models/${model.id}`} className={classes.title ?? ""}>
          {model.title}
        </Link>{" "}
        {model.kind === "synthetic" && <Synthetic />}
      </Table.Td>
      <Table.Td miw={180}>
        {t(`walking.state.${model.state}`)}
        <FitProgress model={model} />
        {model.trouble !== null && <span className={classes.sub}>{model.trouble}</span>}
      </Table.Td>
      <Table.Td>
        {model.walk_set.title}
        {model.walks !== null && (
          <span className={classes.sub}>
            {t("walking.walksOf", {
              walks: number(model.walks, language),
              people: number(model.people ?? 0, language),
            })}
          </span>
        )}
      </Table.Td>
      <CreatedCell at={model.at} by={model.by} />
      <Table.Td className={classes.rowActions ?? ""}>
        <ModelActions model={model} />
      </Table.Td>
    </Table.Tr>
  );
}

interface ModelActionsProps {
  readonly model: ModelListed;
  readonly onDeleted?: () => void;
}

const NOTHING = () => {};

export function ModelActions({
  model,
  onDeleted = NOTHING,
}: ModelActionsProps): JSX.Element | null {
  const { t } = useTexts();
  const canWrite = usePermissions()("walking");
  const queries = useQueryClient();
  const act = useMutation({
    mutationFn: (what: "stop" | "resume") =>
      what === "stop" ? walking.stopModel(model.id) : walking.resumeModel(model.id),
    onSettled: () => queries.invalidateQueries({ queryKey: modelsQuery.queryKey }),
  });
  if (!canWrite) return null;
  const what = model.state === "fitting" ? "stop" : "resume";
  return (
    <>
      {model.state !== "ready" && (
        <Button
          size="compact-sm"
          variant="default"
          loading={act.isPending}
          aria-label={t(`walking.${what}.of`, { title: model.title })}
          onClick={() => act.mutate(what)}
        >
          {t(`walking.${what}`)}
        </Button>
      )}
      <DeleteButton
        title={model.title}
        remove={() => walking.removeModel(model.id)}
        changes={modelsQuery.queryKey}
        onDone={onDeleted}
      />
      {act.isError && <Failure error={act.error} />}
    </>
  );
}

interface FitProgressProps {
  readonly model: ModelListed;
  readonly named?: boolean;
}

/** The progress of a fit. */
export function FitProgress({ model, named }: FitProgressProps): JSX.Element | null {
  const { t } = useTexts();
  if (model.state === "ready" || model.state === "failed") return null;
  const {
    stage,
    maps,
    maps_total: total,
  } = model.progress ?? {
    stage: "waiting" as const,
    maps: 0,
    maps_total: 0,
  };
  const progress =
    total > 0 && stage !== "blending"
      ? t("walking.stage.maps", { maps, total })
      : t(`walking.stage.${stage}`);
  return (
    <div role="status">
      {named === true && <strong>{t("walking.fitting", { title: model.title })}</strong>}
      <Progress
        value={total > 0 ? (100 * maps) / total : 0}
        animated={model.state === "fitting"}
        color={model.state === "fitting" ? "petrol" : "gray"}
        aria-label={t("walking.progress", { title: model.title })}
        my={4}
      />
      <span className={classes.sub}>
        {model.state === "stopped" ? t("walking.state.stopped.at", { maps, total }) : progress}
      </span>
    </div>
  );
}
