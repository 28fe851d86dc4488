/** A slice of the map of suitability: how suitable pairs of steering parameters are. */
import { Figure } from "@charts/Figure";
import { Select, Slider, Title } from "@mantine/core";
import type { Prediction, Slice } from "@shared/api/walking";
import { number } from "@shared/format";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useMemo, useState } from "react";
import { useTexts } from "../i18n";
import { Loaded } from "../ui/Loaded";
import { useDependencyWord, useParameter } from "./dependencyNames";
import { sliceQuery } from "./queries";
import classes from "./Walking.module.css";
import { Synthetic } from "./WalkingTable";
import { sliceFigure } from "./walkingFigures";

interface SlicePanelProps {
  readonly modelId: string;
  readonly prediction: Prediction;
}

const FIRST = "angular";
const MIDDLE = 1;

/** Join words as in a sentence: `length, turning and stature`. */
const listed = (words: readonly string[], language: string): string =>
  new Intl.ListFormat(language, { type: "conjunction" }).format(words);

export function SlicePanel({ modelId, prediction }: SlicePanelProps): JSX.Element {
  const { t, language } = useTexts();
  const word = useDependencyWord();
  const [held, setFixed] = useState(FIRST);
  const [value, setValue] = useState(MIDDLE);
  const { dependencies } = prediction;
  const query = useQuery(sliceQuery(modelId, { dependencies, held, value }));
  return (
    <section className={classes.card} aria-label={t("walking.slice")}>
      <div className={classes.cardHead}>
        <Title order={2} size="h3">
          {t("walking.slice")}
        </Title>
        {prediction.kinds.includes("synthetic") && <Synthetic />}
      </div>
      <p className={classes.soft}>
        {t("walking.slice.lead", { what: listed(Object.keys(dependencies).map(word), language) })}
      </p>
      <Loaded query={query}>
        {(slice) => (
          <SliceView
            slice={slice}
            prediction={prediction}
            fixed={held}
            onFixed={setFixed}
            onValue={setValue}
          />
        )}
      </Loaded>
    </section>
  );
}

interface SliceViewProps {
  readonly slice: Slice;
  readonly prediction: Prediction;
  readonly fixed: string;
  readonly onFixed: (held: string) => void;
  readonly onValue: (value: number) => void;
}

function SliceView({ slice, prediction, fixed, onFixed, onValue }: SliceViewProps): JSX.Element {
  const { t, language } = useTexts();
  const parameter = useParameter();
  const units = { [slice.x.name]: slice.x, [slice.y.name]: slice.y, [slice.held.name]: slice.held };
  const axisTitle = (name: string) => parameter(name, units[name]?.unit ?? "");
  // biome-ignore lint/correctness/useExhaustiveDependencies: words follow the language.
  const figure = useMemo(
    () =>
      sliceFigure(slice, prediction, {
        parameter,
        suitability: t("walking.suitability"),
        drawn: t("walking.shown"),
        stat: t("walking.stat"),
        adapt: t("walking.adapt"),
      }),
    [slice, prediction, language],
  );
  const { low, high } = slice.held;
  return (
    <>
      <div className={classes.choices}>
        <Select
          label={t("walking.held")}
          data={slice.order.map((name) => ({ value: name, label: axisTitle(name) }))}
          value={fixed}
          onChange={(name) => name !== null && onFixed(name)}
          allowDeselect={false}
        />
        <Slider
          // Follows the pointer while dragged; the value is requested once it is released.
          key={slice.held.name}
          thumbLabel={t("walking.held.at", { what: axisTitle(slice.held.name) })}
          label={(at) => number(at, language)}
          defaultValue={slice.held_at}
          min={low}
          max={high}
          step={(high - low) / 20}
          marks={[
            { value: low, label: number(low, language) },
            { value: high, label: number(high, language) },
          ]}
          onChangeEnd={onValue}
          mb="lg"
        />
      </div>
      <p className={classes.soft} role="status">
        {t("walking.held.is", {
          what: axisTitle(slice.held.name),
          value: number(slice.held_at, language),
        })}
      </p>
      <Figure
        figure={figure}
        label={t("walking.slice")}
        watermark={prediction.kinds.includes("synthetic") ? t("walking.watermark") : null}
        loading={t("walking.drawing")}
        failed={t("walking.notDrawn")}
      />
    </>
  );
}
