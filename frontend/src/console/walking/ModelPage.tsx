/** One model: what it was fitted on and how, and how well it predicts unseen walks. */
import { Figure } from "@charts/Figure";
import { Button, Title } from "@mantine/core";
import { type Model, type Range, walking } from "@shared/api/walking";
import { dateTime, decimals, number } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { useQuery } from "@tanstack/react-query";
import { type JSX, useMemo } from "react";
import { Link, useLocation } from "wouter";
import { nameOf } from "../account";
import { type Key, useTexts } from "../i18n";
import { Loaded } from "../ui/Loaded";
import { useTitle } from "../ui/page";
import { ScrollBox } from "../ui/tables";
import { useDependencyLabel, useParameter } from "./dependencyNames";
import { namedNumber } from "./furtherNumbers";
import { FitProgress, ModelActions } from "./ModelTable";
import { modelQuery } from "./queries";
import classes from "./Walking.module.css";
import { Synthetic } from "./WalkingTable";
import { inModelsScene, useWalkedScenes } from "./walkedScenes";
import { censusFigure } from "./walkingFigures";

export function ModelPage({ id }: { readonly id: string }): JSX.Element {
  const { t } = useTexts();
  return (
    <>
      <Link href="/walking/models" className={classes.crumbs ?? ""}>
        <Icon name="back" size={16} />
        {t("walking.models")}
      </Link>
      <Loaded query={useQuery(modelQuery(id))}>{(model) => <ModelDetails model={model} />}</Loaded>
    </>
  );
}

function ModelDetails({ model }: { readonly model: Model }): JSX.Element {
  const { t } = useTexts();
  const [, navigate] = useLocation();
  useTitle(model.title);
  return (
    <>
      <div className={classes.section}>
        <div className={classes.buttons}>
          <Title order={1}>{model.title}</Title>
          {model.kind === "synthetic" && <Synthetic />}
        </div>
        <div className={classes.buttons}>
          {model.state === "ready" && (
            <Button
              component="a"
              href={walking.modelFile(model.id)}
              download
              variant="default"
              leftSection={<Icon name="download" size={18} />}
            >
              {t("walking.model.file")}
            </Button>
          )}
          <ModelActions model={model} onDeleted={() => navigate("/walking/models")} />
        </div>
      </div>
      <FitProgress model={model} />
      {model.trouble !== null && <p role="alert">{model.trouble}</p>}
      <div className={classes.ask}>
        <div className={classes.column}>
          <About model={model} />
          {model.summary !== null && <PredictedDurations summary={model.summary} />}
          {model.summary !== null && <HeldOutWalks model={model} summary={model.summary} />}
        </div>
        {model.summary !== null && <Census model={model} summary={model.summary} />}
      </div>
    </>
  );
}

/** As many characters as the name of the downloaded file has. */
const SHOWN_OF_HASH = 12;
/** How the method begins that leaves one of the model's further numbers out. */
const WITHOUT = "mixed without ";
const wordsOf = (method: string): string => namedNumber(method.slice(WITHOUT.length)).words;

type Summary = NonNullable<Model["summary"]>;

interface PartProps {
  readonly model: Model;
  readonly summary: Summary;
}

function About({ model }: { readonly model: Model }): JSX.Element {
  const { t, language } = useTexts();
  const n = (value: number) => number(value, language);
  const label = useDependencyLabel();
  const inScenes = useWalkedScenes();
  const range = (one: Range) => t("walking.range", { from: n(one.low), to: n(one.high) });
  const { summary, options, scene } = model;
  const unnamed =
    scene?.title ??
    t(
      model.walk_set.origin === "population"
        ? "walking.model.scene.own"
        : "walking.model.scene.open",
    );
  const ordered = model.walk_set.scenes ?? [];
  const titles = new Map(ordered.map(({ key, title }) => [key, title]));
  // Once fitted, the walks that are used, without those that were left out.
  const walked =
    summary?.scenes?.map((one) => ({ ...one, title: titles.get(one.key) ?? one.key ?? "" })) ??
    ordered;
  const facts: (readonly [string, string])[] = [
    [t("walking.fact.on"), model.walk_set.title],
    [
      t("walking.model.scene"),
      walked.some(({ key }) => key !== null) ? inScenes(inModelsScene(walked, scene)) : unnamed,
    ],
    [t("walking.fact.by"), `${nameOf(model.by)}, ${dateTime(model.at, language)}`],
    [
      t("walking.fact.options"),
      t("walking.fact.options.are", {
        steps: options.steps ?? 0,
        k: options.k ?? 0,
        entries: n(options.entries ?? 0),
        seed: options.seed ?? 0,
      }),
    ],
  ];
  if (summary !== null) {
    const { reading } = summary;
    facts.push(
      [
        t("walking.fact.walks"),
        t("walking.walksOf", { walks: n(summary.walks), people: n(summary.people) }),
      ],
      ...Object.entries(summary.dependencies).map(
        ([name, one]) => [label(name), range(one)] as const,
      ),
      [
        t("walking.fact.reading"),
        t("walking.fact.reading.is", {
          normalisation: reading.normalisation,
          power: n(reading.power),
          tau: reading.time_constant_s === null ? "–" : `${n(reading.time_constant_s)} s`,
        }),
      ],
      [t("walking.fact.hash"), summary.model_hash.slice(0, SHOWN_OF_HASH)],
    );
  }
  return (
    <section className={classes.card}>
      <Title order={2} size="h3" mb="xs">
        {t("walking.fact")}
      </Title>
      <dl className={classes.facts}>
        {facts.map(([name, value]) => (
          <Fact key={name} name={name} value={value} />
        ))}
      </dl>
      <LeftOutWalks walks={summary?.left_out_walks ?? []} />
    </section>
  );
}

const Fact = ({ name, value }: { readonly name: string; readonly value: string }): JSX.Element => (
  <>
    <dt>{name}</dt>
    <dd className="numbers">{value}</dd>
  </>
);

/** The walks that the model does not use, each with its reason. */
function LeftOutWalks({
  walks,
}: {
  readonly walks: NonNullable<Summary["left_out_walks"]>;
}): JSX.Element | null {
  const { t } = useTexts();
  if (walks.length === 0) return null;
  return (
    <details>
      <summary className={classes.soft}>{t("walking.without", { count: walks.length })}</summary>
      <ul className={classes.soft}>
        {walks.map(({ walk, reason }) => (
          <li key={walk}>
            {walk}: {reason}
          </li>
        ))}
      </ul>
    </details>
  );
}

function PredictedDurations({ summary }: { readonly summary: Summary }): JSX.Element | null {
  const { t, language } = useTexts();
  const { predicted } = summary;
  if (predicted === null || predicted === undefined) return null;
  const noInterval = predicted[0]?.no_interval;
  const given = noInterval === null || noInterval === undefined;
  const s = (value: number) => decimals(value, language, 3);
  const percent = (share: number) => decimals(100 * share, language, 0);
  const method = (name: string) =>
    name.startsWith(WITHOUT)
      ? t("walking.predicted.without", { what: wordsOf(name) })
      : t(`walking.predicted.${name}` as Key);
  const needless = predicted
    .filter((one) => one.method.startsWith(WITHOUT) && one.crps_less_s[0] <= 0)
    .map((one) => wordsOf(one.method));
  return (
    <section className={classes.card}>
      <Title order={2} size="h3">
        {t("walking.predicted")}
      </Title>
      {predicted.length === 0 ? (
        <p className={classes.soft}>{t("walking.predicted.none")}</p>
      ) : (
        <>
          <p className={classes.soft}>{t("walking.predicted.lead")}</p>
          <ScrollBox label={t("walking.predicted")}>
            <table className={classes.numbersTable}>
              <thead>
                <tr>
                  <th>{t("walking.predicted.method")}</th>
                  <th>{t("walking.predicted.crps")}</th>
                  <th>{t(given ? "walking.predicted.less" : "walking.predicted.lessAlone")}</th>
                  <th>{t("walking.predicted.inside")}</th>
                </tr>
              </thead>
              <tbody>
                {predicted.map((one) => {
                  const [less, from, to] = one.crps_less_s;
                  return (
                    <tr key={one.method}>
                      <td>{method(one.method)}</td>
                      <td className="numbers">{s(one.crps_s)}</td>
                      <td className="numbers">
                        {one.method === "mixed"
                          ? "–"
                          : from === null || to === null
                            ? s(less)
                            : t("walking.predicted.range", {
                                value: s(less),
                                from: s(from),
                                to: s(to),
                              })}
                      </td>
                      <td className="numbers">
                        {percent(one.coverage_50)} / {percent(one.coverage_90)}
                      </td>
                    </tr>
                  );
                })}
              </tbody>
            </table>
          </ScrollBox>
          {!given && (
            <p className={classes.soft}>{t("walking.predicted.noInterval", { why: noInterval })}</p>
          )}
          {needless.length > 0 && (
            <div className={classes.after}>
              <Notice tone="warn">
                {t("walking.predicted.needless", { what: needless.join(", ") })}
              </Notice>
            </div>
          )}
        </>
      )}
    </section>
  );
}

function HeldOutWalks({ summary }: PartProps): JSX.Element {
  const { t, language } = useTexts();
  const n = (value: number) => number(value, language, 3);
  const best = summary.readings[0];
  return (
    <section className={classes.card}>
      <Title order={2} size="h3">
        {t("walking.leftOut")}
      </Title>
      <p className={classes.soft}>{t("walking.leftOut.lead")}</p>
      <ScrollBox label={t("walking.leftOut")}>
        <table className={classes.numbersTable}>
          <thead>
            <tr>
              <th>{t("walking.leftOut.what")}</th>
              <th>{t("walking.leftOut.mean")}</th>
              <th>{t("walking.leftOut.sd")}</th>
              <th>{t("walking.leftOut.n")}</th>
            </tr>
          </thead>
          <tbody>
            {(["neighbours", "nodes", "people"] as const).map((name) => (
              <tr key={name}>
                <td>{t(`walking.leftOut.${name}`)}</td>
                <td className="numbers">{n(summary.left_out[name].mean_percent)}</td>
                <td className="numbers">{n(summary.left_out[name].sd_percent)}</td>
                <td className="numbers">{number(summary.left_out[name].entries, language)}</td>
              </tr>
            ))}
          </tbody>
        </table>
      </ScrollBox>
      {best !== undefined && (
        <p className={classes.soft}>
          {t("walking.leftOut.crps", { value: n(best.crps_s), tried: summary.readings.length })}
        </p>
      )}
    </section>
  );
}

function Census({ model, summary }: PartProps): JSX.Element {
  const { t, language } = useTexts();
  const parameter = useParameter();
  const n = (value: number) => number(value, language);
  // biome-ignore lint/correctness/useExhaustiveDependencies: words follow the language.
  const figure = useMemo(
    () =>
      censusFigure(summary.census, {
        length: t("walking.axis.length"),
        count: t("walking.axis.paths"),
      }),
    [summary, language],
  );
  const synthetic = model.kind === "synthetic";
  return (
    <div className={classes.card}>
      <div className={classes.cardHead}>
        <Title order={2} size="h3">
          {t("walking.census")}
        </Title>
        {synthetic && <Synthetic />}
      </div>
      <Figure
        figure={figure}
        label={t("walking.census")}
        watermark={synthetic ? t("walking.watermark") : null}
        loading={t("walking.drawing")}
        failed={t("walking.notDrawn")}
      />
      <p className={classes.soft}>
        {t("walking.census.told", {
          from: n(summary.census.quartiles_m[0]),
          to: n(summary.census.quartiles_m[2]),
          median: n(summary.census.quartiles_m[1]),
          cutoff: n(summary.census.cutoff_m),
        })}
      </p>
      <p className={classes.soft}>
        {t("walking.stat")}:{" "}
        {summary.parameters
          .map(
            ({ name, unit }, at) => `${parameter(name, unit)} ${n(summary.static_vector[at] ?? 0)}`,
          )
          .join(" · ")}
      </p>
    </div>
  );
}
