/** In numbers: the last seconds of the watched axis, its last step, and the last push. */
import { Table } from "@mantine/core";
import { decimals } from "@shared/format";
import type { JSX } from "react";
import { axisName } from "../../avatarChanges/axes";
import { groupName } from "../../avatarChanges/words";
import { useTexts } from "../../i18n";
import { type PushFigures, WATCHED_AFTER_S } from "./physics/deflection";
import type { Progress } from "./physics/tryout";
import type { WatchedStep } from "./steps";
import classes from "./Tryout.module.css";
import type { Summary } from "./traces";
import { useFigures } from "./useFigures";
import type { LiveTryout } from "./useTryout";

interface FiguresProps {
  readonly live: LiveTryout;
  readonly names: readonly string[];
}

/** One body. */
interface Column {
  readonly summary: Summary | null;
  readonly step: WatchedStep | null;
  readonly now: Progress | undefined;
}

type Row = readonly [key: string, words: (column: Column) => string];
const NONE = "–";
const NO_COLUMNS: readonly Column[] = [];
const DEGREES = 180 / Math.PI;

export function Figures({ live, names }: FiguresProps): JSX.Element {
  const texts = useTexts();
  const { t } = texts;
  const columns = useFigures(
    live.run,
    ({ traces, progress }) =>
      traces.map(({ summary, step }, row) => ({ summary, step, now: progress[row] })),
    NO_COLUMNS,
  );
  const words = wordsOf(texts.language);
  const pushes = columns.flatMap(({ now }) => (now?.push == null ? [] : [now.push]));
  const [pushed] = pushes;
  return (
    <div className={classes.figures}>
      <Part
        title={t("tryout.figure")}
        names={names}
        columns={columns}
        rows={axisRows(words)}
        note={limitedInWords(texts, columns)}
      />
      <div>
        <Part
          title={t("tryout.step.title")}
          names={names}
          columns={columns}
          rows={stepRows(words, t)}
          note={t("tryout.step.note")}
        />
        <Part
          title={
            pushed === undefined
              ? t("tryout.pushed.title")
              : t("tryout.pushed.part", { part: groupName(texts, pushed.part) })
          }
          names={names}
          columns={columns}
          rows={pushRows(words, t)}
          note={t(
            pushes.some(({ isAlone }) => !isAlone) ? "tryout.pushed.others" : "tryout.pushed.note",
          )}
        />
      </div>
    </div>
  );
}

interface PartProps {
  readonly title: string;
  readonly names: readonly string[];
  readonly columns: readonly Column[];
  readonly rows: readonly Row[];
  readonly note?: string;
}

function Part({ title, names, columns, rows, note }: PartProps): JSX.Element {
  const { t } = useTexts();
  return (
    <div>
      <Table verticalSpacing={3} className={classes.table}>
        <Table.Thead>
          <Table.Tr>
            <Table.Th>{title}</Table.Th>
            {names.map((name) => (
              <Table.Th key={name} ta="right">
                {name}
              </Table.Th>
            ))}
          </Table.Tr>
        </Table.Thead>
        <Table.Tbody className="numbers">
          {rows.map(([key, words]) => (
            <Table.Tr key={key}>
              <Table.Th scope="row">{t(`tryout.figure.${key}` as "tryout.figure.target")}</Table.Th>
              {names.map((name, row) => {
                const column = columns[row];
                return (
                  <Table.Td key={name} ta="right" data-figure={row === 0 ? key : undefined}>
                    {column === undefined ? NONE : words(column)}
                  </Table.Td>
                );
              })}
            </Table.Tr>
          ))}
        </Table.Tbody>
      </Table>
      {note !== undefined && <p className={classes.note}>{note}</p>}
    </div>
  );
}

/** More motors at their limit than these are only counted. */
const NAMED_MOTORS = 3;

/** Which motors of the first body are at their torque limit. */
function limitedInWords(texts: ReturnType<typeof useTexts>, columns: readonly Column[]): string {
  const axes = columns[0]?.now?.saturated ?? [];
  if (axes.length === 0) return texts.t("tryout.motors.none");
  const named = axes.slice(0, NAMED_MOTORS).map((one) => axisName(texts, one));
  return texts.t("tryout.motors.at", {
    motors: [...named, ...(axes.length > NAMED_MOTORS ? ["…"] : [])].join(", "),
  });
}

type Language = ReturnType<typeof useTexts>["language"];
type T = ReturnType<typeof useTexts>["t"];
type Words = ReturnType<typeof wordsOf>;

const wordsOf = (language: Language) => {
  const number = (value: number, digits = 1) => decimals(value, language, digits);
  return {
    deg: (value: number) => `${number(value)}°`,
    nm: (value: number) => `${number(value)}\u00a0N\u00a0m`,
    percent: (value: number, digits = 0) => `${number(value, digits)}\u00a0%`,
    seconds: (value: number) => `${number(value, 2)}\u00a0s`,
  };
};

const axisRows = ({ deg, nm, percent }: Words): readonly Row[] => {
  const of = (words: (summary: Summary) => string) => (one: Column) =>
    one.summary === null ? NONE : words(one.summary);
  return [
    ["target", of(({ targetDeg }) => deg(targetDeg))],
    ["angle", of(({ angleDeg }) => deg(angleDeg))],
    ["error", of(({ errorDeg }) => deg(errorDeg))],
    ["rms", of(({ rmsErrorDeg }) => deg(rmsErrorDeg))],
    ["greatest", of(({ greatestErrorDeg }) => deg(greatestErrorDeg))],
    ["torque", of(({ torqueNm }) => nm(torqueNm))],
    ["limit", of(({ limitNm }) => nm(limitNm))],
    ["saturated", of(({ saturated }) => percent(100 * saturated))],
    ["whole", ({ now }) => (now === undefined ? NONE : deg(DEGREES * now.rmsErrorRad))],
    ["motors", ({ now }) => (now === undefined ? NONE : String(now.saturated.length))],
  ];
};

const stepRows = ({ deg, percent, seconds }: Words, t: T): readonly Row[] => {
  const of = (words: (step: WatchedStep) => string) => (one: Column) =>
    one.step === null ? NONE : words(one.step);
  const reached = (value: number | null, { watchedS }: WatchedStep) =>
    value === null ? t("tryout.notWithin", { time: seconds(watchedS) }) : seconds(value);
  return [
    ["jump", of(({ orderedDeg }) => deg(orderedDeg))],
    ["way", of(({ stepDeg }) => deg(stepDeg))],
    // Without a rise there is nothing that could be overshot.
    [
      "overshoot",
      of(({ overshootPercent, riseS }) => (riseS === null ? NONE : percent(overshootPercent, 1))),
    ],
    ["rise", of((step) => reached(step.riseS, step))],
    ["settling", of((step) => reached(step.settlingS, step))],
    ["steady", of(({ steadyErrorDeg }) => deg(steadyErrorDeg))],
  ];
};

const pushRows = ({ deg, seconds }: Words, t: T): readonly Row[] => {
  const of = (words: (push: PushFigures) => string) => (one: Column) =>
    one.now?.push == null ? NONE : words(one.now.push);
  return [
    ["peak", of(({ peakRad }) => deg(DEGREES * peakRad))],
    [
      "return",
      of(({ returnS, phase }) => {
        if (phase === "pushed") return t("tryout.pushed.acting");
        if (returnS !== null) return seconds(returnS);
        return phase === "watched"
          ? t("tryout.pushed.watched")
          : t("tryout.notWithin", { time: seconds(WATCHED_AFTER_S) });
      }),
    ],
  ];
};
