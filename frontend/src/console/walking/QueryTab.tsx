/** Query a model: draw a path in a scene, and see the durations of walks along it. */
import { NumberInput, Select } from "@mantine/core";
import type { ModelListed, Prediction, Range, Scene, SceneListed } from "@shared/api/walking";
import { decimalMark, number } from "@shared/format";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useMemo, useReducer, useState } from "react";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { Loaded } from "../ui/Loaded";
import { DurationPanel } from "./DurationPanel";
import { changedPath, isCompletePath, NO_PATH } from "./drawnPath";
import { furtherOf, numberLabel } from "./furtherNumbers";
import { NoModel } from "./NoModel";
import { PathPanel } from "./PathPanel";
import { modelQuery, modelsQuery, predictionQuery, sceneQuery, scenesQuery } from "./queries";
import { SlicePanel } from "./SlicePanel";
import classes from "./Walking.module.css";
import { OPEN_FLOOR, openFloor } from "./walkedScenes";

export const SEED = 1;
const COUNT = 500;
const SHOWN = 24;
/** The largest further number that the server takes. */
const FARTHEST = 1e6;

export function QueryTab(): JSX.Element {
  const scenes = useQuery(scenesQuery);
  return (
    <Loaded query={useQuery(modelsQuery)}>
      {(models) => {
        const ready = models.filter(({ state }) => state === "ready");
        if (ready.length === 0) return <NoModel models={models} />;
        return (
          <Loaded query={scenes}>{(all) => <ModelQuery models={ready} scenes={all} />}</Loaded>
        );
      }}
    </Loaded>
  );
}

interface ModelQueryProps {
  readonly models: readonly ModelListed[];
  readonly scenes: readonly SceneListed[];
}

interface Settings {
  readonly stature: number | null;
  /** Further numbers by name, those that are known. */
  readonly others: Readonly<Record<string, number>>;
  readonly count: number;
  readonly seed: number;
}

const USUAL: Settings = { stature: null, others: {}, count: COUNT, seed: SEED };

function ModelQuery({ models, scenes }: ModelQueryProps): JSX.Element {
  const { t } = useTexts();
  const [modelId, setModelId] = useState(models[0]?.id ?? "");
  const [sceneKey, setSceneKey] = useState(scenes.find(({ shipped }) => shipped)?.key ?? "");
  const [path, change] = useReducer(changedPath, NO_PATH);
  const [plans, setPlanned] = useState(true);
  const [settings, set] = useState<Settings>(USUAL);
  const model = models.find(({ id }) => id === modelId) ?? models[0];
  const { further: dependencies, longest } = useDependencies(model);
  const isOpen = sceneKey === OPEN_FLOOR;
  const scene = useQuery({ ...sceneQuery(sceneKey), enabled: sceneKey !== "" && !isOpen });
  // Nothing is in the way of a path that is drawn there.
  const planned = plans && !isOpen;
  const query = useQuery({
    ...predictionQuery(model?.id ?? "", {
      scene: isOpen ? null : sceneKey,
      points_m: ends(path.points, planned).map(([x, y]) => [x, y]),
      planned,
      stature_m: settings.stature,
      others: Object.fromEntries(
        Object.entries(settings.others).filter(([name]) => dependencies.has(name)),
      ),
      count: settings.count,
      seed: settings.seed,
      shown: SHOWN,
    }),
    enabled: model !== undefined && isCompletePath(path.points),
  });
  // The previous answer stays while the next is computed, but not for another path.
  const found = isCompletePath(path.points) && !query.isError ? query.data : undefined;
  const panel = (there: Scene) => (
    <PathPanel
      // A path of another scene is not one of this.
      key={there.key}
      scene={there}
      path={path}
      planned={isOpen ? null : planned}
      prediction={found}
      onPlanned={setPlanned}
      onChange={change}
    />
  );
  return (
    <div className={classes.ask}>
      <div className={classes.column}>
        <div className={`${classes.choices} ${classes.models}`}>
          <Select
            label={t("walking.model")}
            data={models.map(({ id, title, kind }) => ({
              value: id,
              label: kind === "synthetic" ? t("walking.model.synthetic", { title }) : title,
            }))}
            value={model?.id ?? null}
            onChange={(value) => value !== null && setModelId(value)}
            allowDeselect={false}
          />
          <Select
            label={t("walking.scene")}
            data={[
              ...scenes.map(({ key, title }) => ({ value: key, label: title })),
              { value: OPEN_FLOOR, label: t("walking.scene.openFloor") },
            ]}
            value={sceneKey}
            onChange={(value) => {
              if (value === null) return;
              setSceneKey(value);
              change({ do: "set", points: [] });
            }}
            allowDeselect={false}
          />
        </div>
        {isOpen ? (
          panel(openFloor(t("walking.scene.openFloor"), longest))
        ) : (
          <Loaded query={scene} isTall>
            {panel}
          </Loaded>
        )}
        <SettingsRow settings={settings} dependencies={dependencies} onChange={set} />
      </div>
      <div className={classes.column} aria-busy={query.isFetching}>
        <Answer
          model={model}
          prediction={found}
          error={query.isError && isCompletePath(path.points) ? query.error : null}
          busy={query.isFetching}
        />
      </div>
    </div>
  );
}

interface Dependencies {
  /** The further numbers on which a model depends, with their ranges in its walks. */
  readonly further: ReadonlyMap<string, Range>;
  /** The length of its longest path, m. */
  readonly longest: number;
}

const NO_DEPENDENCIES: Dependencies = { further: new Map(), longest: 4 };

function useDependencies(model: ModelListed | undefined): Dependencies {
  const found = useQuery({ ...modelQuery(model?.id ?? ""), enabled: model !== undefined }).data;
  return useMemo(() => {
    const all = found?.summary?.dependencies;
    if (all === undefined) return NO_DEPENDENCIES;
    const further = new Map(
      furtherOf(Object.keys(all)).flatMap((name) => {
        const range = all[name];
        return range === undefined ? [] : [[name, range] as const];
      }),
    );
    return { further, longest: all["length_m"]?.high ?? NO_DEPENDENCIES.longest };
  }, [found]);
}

/** The ends of a path that the server plans; the points between them are not part of that query. */
const ends = <T,>(points: readonly T[], planned: boolean): readonly T[] =>
  planned && points.length > 2 ? points.filter((_, at) => at % (points.length - 1) === 0) : points;

interface AnswerProps {
  readonly model: ModelListed | undefined;
  readonly prediction: Prediction | undefined;
  readonly error: Error | null;
  readonly busy: boolean;
}

function Answer({ model, prediction, error, busy }: AnswerProps): JSX.Element {
  const { t } = useTexts();
  if (error !== null) return <Failure error={error} />;
  if (prediction === undefined || model === undefined) {
    return (
      <section className={classes.card}>
        <p className={classes.soft} role="status">
          {t(busy ? "walking.computing" : "walking.draw.first")}
        </p>
      </section>
    );
  }
  return (
    <>
      <DurationPanel prediction={prediction} busy={busy} />
      <SlicePanel modelId={model.id} prediction={prediction} />
    </>
  );
}

interface SettingsRowProps {
  readonly settings: Settings;
  readonly dependencies: ReadonlyMap<string, Range>;
  readonly onChange: (settings: Settings) => void;
}

function SettingsRow({ settings, dependencies, onChange }: SettingsRowProps): JSX.Element {
  const { t, language } = useTexts();
  const setOther = (which: string, value: number | string) => {
    const { [which]: _, ...others } = settings.others;
    const given = inRange(value, -FARTHEST, FARTHEST);
    onChange({ ...settings, others: given === undefined ? others : { ...others, [which]: given } });
  };
  const n = (value: number) => number(value, language);
  return (
    <div className={classes.choices}>
      <NumberInput
        label={t("walking.stature")}
        placeholder={t("walking.stature.mean")}
        value={settings.stature ?? ""}
        onChange={(value) => onChange({ ...settings, stature: inRange(value, 0.5, 2.6) ?? null })}
        min={0.5}
        max={2.6}
        step={0.01}
        decimalScale={2}
        decimalSeparator={decimalMark(language)}
      />
      {[...dependencies].map(([name, range]) => (
        <NumberInput
          key={name}
          label={numberLabel(name)}
          description={t("walking.other.range", { from: n(range.low), to: n(range.high) })}
          placeholder={t("walking.other.mean", { value: n(range.mean) })}
          value={settings.others[name] ?? ""}
          onChange={(value) => setOther(name, value)}
          min={-FARTHEST}
          max={FARTHEST}
          decimalSeparator={decimalMark(language)}
        />
      ))}
      <NumberInput
        label={t("walking.count")}
        value={settings.count}
        onChange={(value) =>
          onChange({ ...settings, count: inRange(value, 20, 5000) ?? settings.count })
        }
        min={20}
        max={5000}
        step={100}
        allowDecimal={false}
      />
      <NumberInput
        label={t("walking.seed")}
        value={settings.seed}
        onChange={(value) =>
          onChange({ ...settings, seed: inRange(value, 0, 2 ** 31 - 1) ?? settings.seed })
        }
        min={0}
        max={2 ** 31 - 1}
        allowDecimal={false}
      />
    </div>
  );
}

const inRange = (value: number | string, low: number, high: number): number | undefined =>
  typeof value === "number" && value >= low && value <= high ? value : undefined;
