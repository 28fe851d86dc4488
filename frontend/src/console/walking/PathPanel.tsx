/** The scene with the path, and the same path as numbers for people who do not draw. */
import { ActionIcon, Button, NumberInput, Select, Switch, Title } from "@mantine/core";
import type { Point, Prediction, Scene } from "@shared/api/walking";
import { decimalMark, number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { type Dispatch, type JSX, useState } from "react";
import { useTexts } from "../i18n";
import { type DrawnPath, hasEndsOf, type PathChange } from "./drawnPath";
import { SceneDrawing } from "./SceneDrawing";
import classes from "./Walking.module.css";
import { Synthetic } from "./WalkingTable";

interface PathPanelProps {
  readonly scene: Scene;
  readonly path: DrawnPath;
  /** Whether the path is planned; null where there is nothing to plan around. */
  readonly planned: boolean | null;
  readonly prediction: Prediction | undefined;
  readonly onPlanned: (planned: boolean) => void;
  readonly onChange: Dispatch<PathChange>;
}

export function PathPanel(props: PathPanelProps): JSX.Element {
  const { scene, path, planned, onPlanned, onChange } = props;
  const { t, language } = useTexts();
  // While the next path is computed, the answer is still that of the last one.
  const prediction =
    props.prediction !== undefined && hasEndsOf(props.prediction.points_m, path.points)
      ? props.prediction
      : undefined;
  const seenAt = (prediction?.quantiles_s.p50 ?? 0) / 2;
  const synthetic = prediction?.kinds.includes("synthetic") ?? false;
  return (
    <section className={classes.card} aria-label={t("walking.path")}>
      <div className={classes.cardHead}>
        <Title order={2} size="h3">
          {t("walking.path")}
        </Title>
        {synthetic && <Synthetic />}
        <div className={classes.buttons}>
          {planned !== null && (
            <Switch
              label={t("walking.plan")}
              checked={planned}
              onChange={(event) => onPlanned(event.currentTarget.checked)}
            />
          )}
          <Button
            size="compact-sm"
            variant="default"
            disabled={path.before.length === 0}
            onClick={() => onChange({ do: "undo" })}
          >
            {t("walking.undo")}
          </Button>
          <Button
            size="compact-sm"
            variant="default"
            disabled={path.points.length === 0}
            onClick={() => onChange({ do: "set", points: [] })}
          >
            {t("walking.clear")}
          </Button>
        </div>
      </div>
      <SceneDrawing
        scene={scene}
        points={path.points}
        planned={planned ?? false}
        plannedPath={prediction?.points_m ?? null}
        walkers={prediction?.walkers ?? []}
        synthetic={synthetic}
        atS={seenAt}
        onChange={onChange}
      />
      {prediction !== undefined && (
        <p className={classes.soft}>
          {t("walking.seen", {
            count: prediction.walkers.length,
            value: number(seenAt, language, 1),
          })}
        </p>
      )}
      <p className={classes.soft}>{t(planned ? "walking.hint.planned" : "walking.hint.drawn")}</p>
      <Places scene={scene} points={path.points} onChange={onChange} />
      <Numbers points={path.points} onChange={onChange} />
    </section>
  );
}

/** The paths of the scene, with the one that is drawn. */
function Places({
  scene,
  points,
  onChange,
}: {
  readonly scene: Scene;
  readonly points: readonly Point[];
  readonly onChange: Dispatch<PathChange>;
}): JSX.Element | null {
  const { t } = useTexts();
  const [chosen, setChosen] = useState<string | null>(null);
  if (scene.paths.length === 0) return null;
  const endsOf = (name: string | null): readonly Point[] => {
    const path = scene.paths.find((one) => one.name === name);
    return [path?.start, path?.goal].flatMap((place) => {
      const point = scene.places[place ?? ""];
      return point === undefined ? [] : [point];
    });
  };
  return (
    <Select
      label={t("walking.scenePath")}
      placeholder={t("walking.scenePath.choose")}
      data={scene.paths.map(({ name }) => name)}
      value={points.length === 2 && hasEndsOf(endsOf(chosen), points) ? chosen : null}
      onChange={(name) => {
        setChosen(name);
        const ends = endsOf(name);
        if (ends.length === 2) onChange({ do: "set", points: ends });
      }}
      allowDeselect={false}
      mt="xs"
    />
  );
}

interface NumbersProps {
  readonly points: readonly Point[];
  readonly onChange: Dispatch<PathChange>;
}

function Numbers({ points, onChange }: NumbersProps): JSX.Element {
  const { t, language } = useTexts();
  const last = points.at(-1) ?? [0, 0];
  return (
    <details>
      <summary className={classes.soft}>{t("walking.numbers")}</summary>
      <table className={classes.numbersTable}>
        <thead>
          <tr>
            <th>{t("walking.point")}</th>
            <th>{t("walking.x")}</th>
            <th>{t("walking.y")}</th>
            <td />
          </tr>
        </thead>
        <tbody>
          {points.map((point, at) => (
            // biome-ignore lint/suspicious/noArrayIndexKey: a point is identified by its position in the path
            <tr key={at}>
              <td className="numbers">{at + 1}</td>
              {[0, 1].map((axis) => (
                <td key={axis}>
                  <NumberInput
                    aria-label={t(axis === 0 ? "walking.x.of" : "walking.y.of", { at: at + 1 })}
                    size="xs"
                    step={0.1}
                    decimalScale={2}
                    decimalSeparator={decimalMark(language)}
                    value={point[axis] ?? 0}
                    onChange={(value) => {
                      if (typeof value !== "number") return;
                      const moved: Point = axis === 0 ? [value, point[1]] : [point[0], value];
                      onChange({ do: "move", at, point: moved });
                    }}
                  />
                </td>
              ))}
              <td>
                <ActionIcon
                  variant="subtle"
                  color="gray"
                  aria-label={t("walking.remove", { at: at + 1 })}
                  onClick={() => onChange({ do: "remove", at })}
                >
                  <Icon name="close" size={16} />
                </ActionIcon>
              </td>
            </tr>
          ))}
        </tbody>
      </table>
      <Button
        size="compact-sm"
        variant="default"
        onClick={() => onChange({ do: "add", point: [last[0] + 0.5, last[1]] })}
      >
        {t("walking.add")}
      </Button>
    </details>
  );
}
