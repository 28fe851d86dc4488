/** One phase, or two side by side, played on one clock. */
import { Center, Checkbox, Loader } from "@mantine/core";
import { useDisclosure, useLocalStorage } from "@mantine/hooks";
import { isApiError } from "@shared/api/request";
import type { SessionView } from "@shared/api/types";
import type { CameraMode, CameraSide } from "@shared/stage/figure";
import type { StageHandle } from "@shared/stage/Stage";
import { usePlayback } from "@shared/stage/usePlayback";
import { inLanguage } from "@shared/text";
import { seconds } from "@shared/units";
import { type JSX, type ReactNode, useMemo, useRef, useState } from "react";
import { DrawnAs } from "../bodyView/DrawnAs";
import { CameraBar } from "../captures/Viewer";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { usePhaseName } from "../steps";
import { EmptyState } from "../ui/EmptyState";
import { addressOf, type PhaseRef, type ReplayParams, type ReplayParamsWithPhase } from "./address";
import { jumpFrom } from "./events";
import { FilmButton } from "./FilmButton";
import type { FilmWords } from "./film";
import { BackLink, Head } from "./Head";
import { ReplayKeys, SPEEDS, useReplayKeys } from "./keys";
import { LaneStage } from "./LaneStage";
import classes from "./Replay.module.css";
import { Side } from "./Side";
import { Tracks } from "./Tracks";
import { Transport } from "./Transport";
import { type Lane, useComparedPhase, useLane } from "./useLane";

interface PlayerProps {
  readonly session: SessionView;
  readonly params: ReplayParamsWithPhase;
  readonly onParams: (params: ReplayParams) => void;
}

export function Player(props: PlayerProps): JSX.Element {
  const { session, params } = props;
  const nameOf = usePhaseName();
  const own = useMemo(
    (): PhaseRef => ({ session: session.id, phase: params.phase }),
    [session.id, params.phase],
  );
  const phase = session.phases.find(({ phase_id }) => phase_id === params.phase);
  const first = useLane(own, phase === undefined ? "" : nameOf(session, phase));
  const compared = useComparedPhase(session, params.comparedWith);
  const second = useLane(compared.ref, compared.label);
  return (
    <div className={classes.page}>
      <Head {...props} comparedSession={compared.session} />
      {first.error !== null && <Refused id={session.id} error={first.error} />}
      {first.error === null && first.lane === null && (
        <Center mih={320}>
          <Loader />
        </Center>
      )}
      {first.lane !== null && (
        <Playing
          {...props}
          lanes={second.lane === null ? [first.lane] : [first.lane, second.lane]}
          refused={second.error}
        />
      )}
    </div>
  );
}

/** Why a phase cannot be replayed, in the reader's language if the reason is known. */
function Refused({ id, error }: { readonly id: string; readonly error: Error }): JSX.Element {
  const { t } = useTexts();
  const reason = isApiError(error, "gone")
    ? ("erased" as const)
    : isApiError(error, "not_now")
      ? ("running" as const)
      : null;
  return (
    <div className={classes.alone}>
      {reason === null ? (
        <Failure error={error} />
      ) : (
        <EmptyState
          icon={reason === "erased" ? "lock" : "clock"}
          title={t(`replay.${reason}`)}
          action={<BackLink id={id} />}
        >
          {t(`replay.${reason}.body`)}
        </EmptyState>
      )}
    </div>
  );
}

interface PlayingProps extends PlayerProps {
  readonly lanes: readonly Lane[];
  readonly refused: Error | null;
}

const CAMERAS: readonly CameraMode[] = ["orbit", "follow", "eyes"];

function Playing({ session, params, lanes, refused }: PlayingProps): JSX.Element {
  const texts = useTexts();
  const duration = seconds(Math.max(...lanes.map(({ replay }) => replay.duration_s)));
  const playback = usePlayback(duration, { time: seconds(params.time), loop: false });
  const [mode, setMode] = useLocalStorage<CameraMode>({
    key: "reembody.replay.camera",
    defaultValue: "orbit",
  });
  const [ghost, setGhost] = useState(true);
  const [boxes, setBoxes] = useState(true);
  const [at, setAt] = useState(0);
  const [help, helps] = useDisclosure();
  const stages = useStages();
  const staged = useRef<HTMLDivElement>(null);
  const shown = lanes[Math.min(at, lanes.length - 1)] as Lane;
  const link = () =>
    new URL(addressOf(session.id, { ...params, time: playback.time }), window.location.href).href;
  // The movement comes later: what it needs has its place from the start.
  const isRecorded = lanes.some(({ replay }) => replay.has_movement);
  const rate = lanes.find(({ movement }) => movement !== null)?.movement?.participant.rateHz ?? 30;
  useReplayKeys({
    toggle: playback.toggle,
    by: (seconds_) => playback.seek(seconds(playback.time + seconds_)),
    frame: (frames) => playback.seek(seconds((Math.round(playback.time * rate) + frames) / rate)),
    jump: (direction) => {
      const to = jumpFrom(shown.all, playback.time, direction);
      if (to !== null) playback.seek(seconds(to));
    },
    end: (direction) => playback.seek(direction < 0 ? seconds(0) : duration),
    camera: () => setMode(CAMERAS[(CAMERAS.indexOf(mode) + 1) % CAMERAS.length] ?? "orbit"),
    speed: (direction) => {
      const next = SPEEDS[(SPEEDS as readonly number[]).indexOf(playback.speed) + direction];
      if (next !== undefined) playback.setSpeed(next);
    },
    help: helps.toggle,
  });
  return (
    <>
      <div className={classes.main}>
        <Options
          lanes={lanes}
          ghost={ghost}
          isGhostSeen={mode !== "eyes"}
          boxes={boxes}
          onGhost={setGhost}
          onBoxes={setBoxes}
          camera={<CameraBar mode={mode} hasEyes stage={stages.all} onMode={setMode} />}
        />
        {refused !== null && <Failure error={refused} />}
        <div ref={staged} className={classes.stages} data-lanes={lanes.length}>
          {lanes.map((lane, index) => (
            <LaneStage
              key={`${lane.ref.session} ${lane.ref.phase}`}
              lane={lane}
              other={lanes[1 - index] ?? null}
              time={playback.time}
              mode={mode}
              ghost={ghost}
              boxes={boxes}
              handle={stages.refs[index] ?? stages.refs[0]}
            />
          ))}
        </div>
        <Transport
          lane={shown}
          playback={playback}
          duration={duration}
          link={link}
          film={
            isRecorded && (
              <FilmButton
                isReady={lanes.some(({ movement }) => movement !== null)}
                stages={staged}
                playback={playback}
                duration={duration}
                words={filmWords(session, lanes, texts)}
                name={filmName(session, params, playback.time)}
              />
            )
          }
          onHelp={helps.open}
        />
        <Tracks lanes={lanes} duration={duration} time={playback.time} onSeek={playback.seek} />
      </div>
      <Side lanes={lanes} at={at} onAt={setAt} playback={playback} />
      <ReplayKeys opened={help} onClose={helps.close} />
    </>
  );
}

/** A film has the stages with movement only, so only their names. */
function filmWords(
  session: SessionView,
  lanes: readonly Lane[],
  { t, language }: ReturnType<typeof useTexts>,
): Omit<FilmWords, "time"> {
  const isPeople = session.kind === "people" || session.kind === "expert";
  return {
    names: lanes.filter(({ movement }) => movement !== null).map(({ label }) => label),
    about: `${inLanguage(session.study_title, language)} · ${session.participant_code}`,
    mark: isPeople ? null : t(`film.mark.${session.kind === "test" ? "test" : "simulated"}`),
  };
}

/** Participant, phase and moment, as far as file systems allow the code. */
function filmName(session: SessionView, { phase }: ReplayParamsWithPhase, time: number): string {
  const code = session.participant_code.replaceAll(/[^\w-]+/g, "_");
  return `${code}_phase${phase}_${time.toFixed(1)}s`;
}

/** The stages' cameras, individually and moved together. */
function useStages() {
  const first = useRef<StageHandle>(null);
  const second = useRef<StageHandle>(null);
  const refs = [first, second] as const;
  const all = useRef<StageHandle>({
    placeCamera: (from: CameraSide) => {
      for (const { current } of refs) current?.placeCamera(from);
    },
    zoom: (factor: number) => {
      for (const { current } of refs) current?.zoom(factor);
    },
  });
  return { refs, all };
}

interface OptionsProps {
  readonly lanes: readonly Lane[];
  readonly ghost: boolean;
  /** Seen through the eyes, the one who sees has no ghost. */
  readonly isGhostSeen: boolean;
  readonly boxes: boolean;
  readonly onGhost: (ghost: boolean) => void;
  readonly onBoxes: (boxes: boolean) => void;
  readonly camera: ReactNode;
}

/** The options of the stage: what is shown, and from where. */
function Options(props: OptionsProps): JSX.Element {
  const { lanes, ghost, isGhostSeen, boxes, onGhost, onBoxes, camera } = props;
  const { t } = useTexts();
  const isRecorded = lanes.some(({ replay }) => replay.has_movement);
  const isFull = lanes.some(({ movement }) => movement?.avatar != null);
  const isWorn = lanes.some(({ replay }) => replay.humanoid != null);
  const hasBoxes = lanes.some(({ replay }) => replay.surfaces.length > 0);
  return (
    <div className={classes.options}>
      {camera}
      <div className={classes.shown}>
        {isWorn && <DrawnAs />}
        {isRecorded && (
          <Checkbox
            size="xs"
            label={t("replay.ghost")}
            checked={ghost}
            disabled={!isFull || !isGhostSeen}
            onChange={(event) => onGhost(event.currentTarget.checked)}
          />
        )}
        {hasBoxes && (
          <Checkbox
            size="xs"
            label={t("replay.boxes")}
            checked={boxes}
            onChange={(event) => onBoxes(event.currentTarget.checked)}
          />
        )}
      </div>
    </div>
  );
}
