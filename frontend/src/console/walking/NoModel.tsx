/** Before any model can be queried: the one being fitted, or how to get one. */
import { Button } from "@mantine/core";
import { type ModelListed, walking } from "@shared/api/walking";
import { useMutation, useQueryClient } from "@tanstack/react-query";
import type { JSX } from "react";
import { Link } from "wouter";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { EmptyState } from "../ui/EmptyState";
import { useSingleSubmit } from "../ui/useSingleSubmit";
import { FitProgress } from "./ModelTable";
import { modelsQuery, walkSetsQuery } from "./queries";
import classes from "./Walking.module.css";

export function NoModel({ models }: { readonly models: readonly ModelListed[] }): JSX.Element {
  const { t } = useTexts();
  const canWrite = usePermissions()("walking");
  const fitting = models.filter(({ state }) => state === "fitting");
  if (fitting.length > 0) {
    return (
      <section className={classes.card}>
        {fitting.map((model) => (
          <FitProgress key={model.id} model={model} named />
        ))}
      </section>
    );
  }
  return (
    <EmptyState icon="walk" title={t("walking.none")} action={canWrite ? <TryIt /> : undefined}>
      {t(canWrite ? "walking.none.body" : "walking.none.reader")}
    </EmptyState>
  );
}

const PEOPLE = 8;

/**
 * Fit a model of synthetic walkers in one step, so that the page can be tried before anybody was
 * tracked.
 */
function TryIt(): JSX.Element {
  const { t } = useTexts();
  const queries = useQueryClient();
  const make = useMutation({
    mutationFn: async () => {
      const title = t("walking.try.title");
      const walks = await walking.addWalkSet({
        title,
        origin: {
          kind: "population",
          population: "students",
          people: PEOPLE,
          repetitions: 1,
          seed: 1,
        },
      });
      return walking.addModel({
        title,
        walk_set_id: walks.id,
        options: { steps: 10, k: 60, entries: 1000, reading: "time-aware", seed: 1 },
      });
    },
    onSettled: () =>
      Promise.all([
        queries.invalidateQueries({ queryKey: modelsQuery.queryKey }),
        queries.invalidateQueries({ queryKey: walkSetsQuery.queryKey }),
      ]),
  });
  const submit = useSingleSubmit(make, { isReused: true });
  return (
    <>
      <div className={classes.buttons}>
        <Button loading={make.isPending} onClick={() => submit()}>
          {t("walking.try")}
        </Button>
        <Button component={Link} href="/walking/models" variant="default">
          {t("walking.none.own")}
        </Button>
      </div>
      {make.isPending && <p className={classes.soft}>{t("walking.try.making")}</p>}
      {make.isError && <Failure error={make.error} />}
    </>
  );
}
