/** The scrubber, and below it the events of the whole phase, on the same scale. */
import { number } from "@shared/format";
import { BLOCK_COLOURS, type BlockTone } from "@shared/stage/figure";
import { type Seconds, seconds } from "@shared/units";
import { type CSSProperties, type JSX, memo, type PointerEvent } from "react";
import { useTexts } from "../i18n";
import { clockAt, endOf, isEverPaused, toneOf } from "./events";
import classes from "./Replay.module.css";
import type { Lane } from "./useLane";

interface TracksProps {
  readonly lanes: readonly Lane[];
  readonly duration: Seconds;
  readonly time: Seconds;
  readonly onSeek: (time: Seconds) => void;
}

const STEP_S = 0.05;

export function Tracks({ lanes, duration, time, onSeek }: TracksProps): JSX.Element {
  const { t, language } = useTexts();
  const replay = lanes[0]?.replay;
  const isGap = lanes[0]?.movement?.gaps.some(([a, b]) => a < time && time < b) ?? false;
  const state = isGap ? "gap" : replay === undefined ? "standing" : clockAt(replay, time);
  const seek = (event: PointerEvent<HTMLDivElement>) => {
    if (event.buttons !== 1) return;
    const { left, width } = event.currentTarget.getBoundingClientRect();
    onSeek(seconds(((event.clientX - left) / width) * duration));
  };
  const share = duration > 0 ? time / duration : 0;
  return (
    <div className={classes.tracks} style={{ "--share": share } as CSSProperties}>
      <input
        type="range"
        className={classes.scrubber}
        aria-label={t("replay.scrubber")}
        aria-valuetext={t("replay.scrubber.value", {
          time: number(time, language, 1),
          duration: number(duration, language, 1),
          state: t(`replay.state.${state}`),
        })}
        min={0}
        max={duration}
        step={STEP_S}
        value={time}
        onChange={(event) => onSeek(seconds(Number(event.currentTarget.value)))}
        onKeyDown={(event) => {
          // Arrow keys do the same here as on the whole page.
          if (event.key.startsWith("Arrow")) event.preventDefault();
        }}
      />
      <div className={classes.rows}>
        <div
          className={classes.seek}
          onPointerDown={(event) => {
            event.currentTarget.setPointerCapture(event.pointerId);
            seek(event);
          }}
          onPointerMove={seek}
        >
          <span className={classes.head_} />
        </div>
        {lanes.map((lane) => (
          <LaneRows
            key={`${lane.ref.session} ${lane.ref.phase}`}
            lane={lane}
            duration={duration}
            named={lanes.length > 1}
          />
        ))}
      </div>
      <TrackKey lanes={lanes} />
    </div>
  );
}

interface LaneRowsProps {
  readonly lane: Lane;
  readonly duration: Seconds;
  readonly named: boolean;
}

/** Rendered once: only the playhead above it moves. */
const LaneRows = memo(function LaneRows({ lane, duration, named }: LaneRowsProps): JSX.Element {
  const { t } = useTexts();
  const { replay, movement } = lane;
  const boxes = replay.contacts.filter(({ surface_kind }) => surface_kind !== "side");
  const sides = replay.contacts.filter(({ surface_kind }) => surface_kind === "side");
  const width = { "--duration": Math.max(duration, 1e-3) } as CSSProperties;
  const end = endOf(replay);
  return (
    <div role="img" aria-label={`${t("replay.tracks")}: ${lane.label}`} style={width}>
      {named && <div className={classes.rowsName}>{lane.label}</div>}
      <Row name={t("replay.track.clock")}>
        <Bar kind="standing" from={0} to={end} />
        {end < replay.duration_s && <Bar kind="over" from={end} to={replay.duration_s} />}
        {replay.active.map((one) => (
          <Bar key={one.begin_s} kind="active" from={one.begin_s} to={one.end_s} />
        ))}
        {movement?.gaps.map(([from, to]) => (
          <Bar key={from} kind="gap" from={from} to={to} />
        ))}
      </Row>
      {replay.surfaces.length > 0 && (
        <>
          <Row name={t("replay.track.boxes")}>
            {boxes.map((one, at) => (
              <Bar
                // biome-ignore lint/suspicious/noArrayIndexKey: they never change their order
                key={at}
                kind={toneOf({ surfaceKind: one.surface_kind, effect: one.effect })}
                from={one.begin_s}
                to={one.end_s}
              />
            ))}
          </Row>
          <Row name={t("replay.track.sides")}>
            {sides.map((one, at) => (
              // biome-ignore lint/suspicious/noArrayIndexKey: they never change their order
              <Bar key={at} kind="bad" from={one.begin_s} to={one.end_s} />
            ))}
          </Row>
          <Row name={t("replay.track.done")}>
            {replay.completions.map(({ number, t_s }) => (
              <Mark key={number} at={t_s} text={String(number)} />
            ))}
          </Row>
        </>
      )}
      {replay.notes.length > 0 && (
        <Row name={t("replay.track.notes")}>
          {replay.notes.map(({ id, t_s }) => (
            <Mark key={id} at={t_s} text="✎" />
          ))}
        </Row>
      )}
    </div>
  );
});

function Row({
  name,
  children,
}: {
  readonly name: string;
  readonly children: React.ReactNode;
}): JSX.Element {
  return (
    <div className={classes.row}>
      <span className={classes.rowName}>{name}</span>
      <div className={classes.rowBody}>{children}</div>
    </div>
  );
}

type BarKind = "active" | "standing" | "over" | "gap" | BlockTone;

interface BarProps {
  readonly kind: BarKind;
  readonly from: number;
  readonly to: number;
}

const colourOf = (kind: BarKind): string | undefined =>
  kind in BLOCK_COLOURS ? BLOCK_COLOURS[kind as keyof typeof BLOCK_COLOURS] : undefined;

function Bar({ kind, from, to }: BarProps): JSX.Element {
  const style = { "--from": from, "--to": to, "--tone": colourOf(kind) } as CSSProperties;
  return <span className={classes.bar} data-kind={kind} style={style} />;
}

function Mark({ at, text }: { readonly at: number; readonly text: string }): JSX.Element {
  return (
    <span className={classes.mark} style={{ "--from": at } as CSSProperties}>
      {text}
    </span>
  );
}

/** The legend of the colours that are present. */
function TrackKey({ lanes }: Pick<TracksProps, "lanes">): JSX.Element {
  const { t } = useTexts();
  const contacts = lanes.flatMap(({ replay }) => replay.contacts);
  const present = new Set<BarKind>(
    contacts.map((one) => toneOf({ surfaceKind: one.surface_kind, effect: one.effect })),
  );
  const hasGaps = lanes.some(({ movement }) => (movement?.gaps.length ?? 0) > 0);
  const kinds: readonly Exclude<BarKind, "plain">[] = [
    "active",
    ...(lanes.some(({ replay }) => isEverPaused(replay)) ? (["standing"] as const) : []),
    ...(lanes.some(({ replay }) => endOf(replay) < replay.duration_s) ? (["over"] as const) : []),
    ...(hasGaps ? (["gap"] as const) : []),
    ...(["good", "odd", "touched", "bad"] as const).filter((kind) => present.has(kind)),
  ];
  return (
    <ul className={classes.key}>
      {kinds.map((kind) => (
        <li key={kind}>
          <span
            className={classes.swatch}
            data-kind={kind}
            style={{ "--tone": colourOf(kind) } as CSSProperties}
          />
          {t(`replay.key.${kind}`)}
        </li>
      ))}
    </ul>
  );
}
