/** A performer on a body: the picture, what body and ground, agreed poses, and recording. */
import {
  ActionIcon,
  Button,
  Checkbox,
  Loader,
  Menu,
  NativeSelect,
  Select,
  Tooltip,
} from "@mantine/core";
import { useLocalStorage } from "@mantine/hooks";
import {
  type AgreedPose,
  type GroundKey,
  type Performer,
  performers,
  type Recording,
} from "@shared/api/performers";
import { decimals, duration } from "@shared/format";
import { Icon } from "@shared/ui/Icon";
import { Notice } from "@shared/ui/Notice";
import { seconds } from "@shared/units";
import { useMutation, useQuery, useQueryClient } from "@tanstack/react-query";
import { type JSX, useEffect, useRef, useState } from "react";
import { BodySelect, useBodyChoice } from "../bodyView/BodyChoice";
import { BodyNotice } from "../bodyView/BodyNotice";
import { CameraSides } from "../bodyView/CameraSides";
import { useBody } from "../bodyView/useBody";
import { AvatarChoice } from "../captures/AvatarChoice";
import { capturesQuery } from "../captures/queries";
import { Failure } from "../errors";
import { useTexts } from "../i18n";
import { usePermissions } from "../permissions";
import { performersQuery } from "../queries";
import classes from "./Performer.module.css";
import { StoreButton, type Stored, StoredNotice, useStoring } from "./Storing";
import { useWatched, type Watched } from "./useWatched";

const GROUNDS: readonly GroundKey[] = ["flat", "ramp", "kerb", "steps"];

interface WatchPanelProps {
  readonly performer: Performer;
  /** The recording of this performer that goes on or is not stored yet, if any. */
  readonly recording: Recording | undefined;
}

export function WatchPanel({ performer, recording }: WatchPanelProps): JSX.Element {
  const { t } = useTexts();
  const root = useRef<HTMLDivElement>(null);
  const [avatar, setAvatar] = useLocalStorage({
    key: "reembody.performer.avatar",
    defaultValue: "165cm",
  });
  const [ground, setGround] = useState<GroundKey>("flat");
  const [isFollowing, setFollowing] = useState(true);
  const choice = useBodyChoice(true);
  const body = useBody(choice.hash);
  const [capture, setCapture] = useState<string | null>(null);
  const wish = { ...nameOf(performer), avatar: capture ?? avatar, ground };
  const watched = useWatched(root, wish, body.model);
  const { scene } = watched;
  useEffect(() => scene?.setFollowing(isFollowing), [scene, isFollowing]);
  const [stored, setStored] = useState<Stored | null>(null);
  const others = watched.state?.others ?? [];
  return (
    <section
      className={classes.panel}
      aria-label={t("performer.panel", { name: titleOf(performer) })}
    >
      <div className={classes.bar}>
        <SkeletonSelect capture={capture} onCapture={setCapture} />
        {capture === null && (
          <>
            <AvatarChoice avatar={avatar} onAvatar={setAvatar} />
            <BodySelect choice={choice} />
          </>
        )}
        <NativeSelect
          size="xs"
          aria-label={t("performer.ground")}
          value={ground}
          onChange={(event) => setGround(event.currentTarget.value as GroundKey)}
          data={GROUNDS.map((value) => ({ value, label: t(`performer.ground.${value}`) }))}
        />
      </div>
      <div className={classes.bar}>
        <CameraSides onLook={(from) => scene?.placeCamera(from)} />
        {(["nearer", "farther"] as const).map((one) => (
          <Tooltip key={one} label={t(`stage.${one}`)}>
            <ActionIcon
              variant="default"
              size="md"
              aria-label={t(`stage.${one}`)}
              onClick={() => scene?.zoom(one === "nearer" ? 0.8 : 1.25)}
            >
              <Icon name={one === "nearer" ? "add" : "minus"} size={15} />
            </ActionIcon>
          </Tooltip>
        ))}
        <Checkbox
          size="xs"
          label={t("performer.follow")}
          checked={isFollowing}
          onChange={(event) => setFollowing(event.currentTarget.checked)}
        />
        <div className={classes.actions}>
          <AgreedPoses performer={performer} isReady={watched.state?.state === "ready"} />
          <Record performer={performer} recording={recording} onStored={setStored} />
        </div>
      </div>
      {stored !== null && <StoredNotice stored={stored} onClose={() => setStored(null)} />}
      <div
        className={classes.frame}
        data-way={watched.drawingState}
        data-moving={watched.figures !== null}
      >
        <div
          ref={root}
          className={classes.canvas}
          role="img"
          aria-label={t("performer.picture", { name: titleOf(performer) })}
        />
        <State watched={watched} />
        <BodyNotice body={body} instead />
      </div>
      {others.length > 0 && (
        <Notice tone="warn">
          {t("performer.others", {
            address: watched.state?.address ?? "",
            others: others.join(", "),
          })}
        </Notice>
      )}
      <Foot performer={performer} watched={watched} />
    </section>
  );
}

const REFERENCE = "reference";

/** The skeleton that moves: one of any stature, or that of a capture, such as a character's. */
function SkeletonSelect({
  capture,
  onCapture,
}: {
  readonly capture: string | null;
  readonly onCapture: (capture: string | null) => void;
}): JSX.Element {
  const { t } = useTexts();
  const { data } = useQuery(capturesQuery);
  const usable = (data?.captures ?? []).filter((one) => one.has_skeleton);
  return (
    <Select
      size="xs"
      w={220}
      searchable
      aria-label={t("performer.skeleton")}
      allowDeselect={false}
      value={capture ?? REFERENCE}
      onChange={(value) => onCapture(value === REFERENCE ? null : value)}
      data={[
        { value: REFERENCE, label: t("performer.skeleton.reference") },
        ...usable.map(({ id, title }) => ({
          value: id,
          label: t("performer.skeleton.capture", { title }),
        })),
      ]}
    />
  );
}

export const nameOf = ({ door, source, skeleton }: Performer) => ({ door, source, skeleton });

export const titleOf = ({ source, skeleton }: Pick<Performer, "source" | "skeleton">): string =>
  skeleton === "" ? source : `${source}, ${skeleton}`;

/** Why nothing moves, shown over the picture. */
function State({ watched }: { readonly watched: Watched }): JSX.Element | null {
  const { t } = useTexts();
  const { drawingState, state, setup, isLost } = watched;
  if (drawingState === "flat") {
    return <Message text={t("stage.flat")} remedy={t("stage.flat.remedy")} />;
  }
  if (isLost && state?.state !== "refused") return <Message text={t("performer.lost")} />;
  if (drawingState === "loading" || state === null) return <Waiting />;
  if (state.state === "ready") return setup === null ? <Waiting /> : null;
  const listed = [...state.missing, ...state.problems].join(", ");
  return (
    <Message
      text={t(`performer.state.${state.state}`)}
      remedy={t(`performer.state.${state.state}.remedy`, { listed })}
    />
  );
}

function Waiting(): JSX.Element {
  const { t } = useTexts();
  return (
    <div className={classes.state}>
      <Loader size="sm" role="status" aria-label={t("stage.loading")} />
    </div>
  );
}

function Message({ text, remedy }: { readonly text: string; readonly remedy?: string }) {
  return (
    <div className={classes.state} role="status">
      <strong>
        <Icon name="alert" size={18} />
        {text}
      </strong>
      {remedy !== undefined && <span>{remedy}</span>}
    </div>
  );
}

/** How it comes in, and what of the body does not move. */
function Foot({
  performer,
  watched,
}: {
  readonly performer: Performer;
  readonly watched: Watched;
}): JSX.Element {
  const { t, language } = useTexts();
  const { figures, setup } = watched;
  const parts = [
    t("performer.bones", { count: performer.bones }),
    ...(performer.in_parent === null
      ? []
      : [t(performer.in_parent ? "performer.inParent" : "performer.inWorld")]),
    ...(performer.is_t_pose_shown ? [t("performer.tPose.shown")] : []),
    ...(setup === null
      ? []
      : [t("performer.scale", { value: decimals(setup.scale, language, 2) })]),
    ...(figures === null
      ? []
      : [
          t("performer.drawn", { value: decimals(figures.drawnHz, language, 0) }),
          t("performer.delay", { value: decimals(figures.delayMs, language, 1) }),
        ]),
    ...(figures !== null && figures.held > 0 ? [t("performer.held", { count: figures.held })] : []),
    ...(setup !== null && setup.unmapped.length > 0
      ? [t("performer.unmapped", { count: setup.unmapped.length })]
      : []),
  ];
  return <p className={`${classes.foot} numbers`}>{parts.join(" · ")}</p>;
}

/** Agreements with the performer about the pose in which they are. */
function AgreedPoses({
  performer,
  isReady,
}: {
  readonly performer: Performer;
  readonly isReady: boolean;
}): JSX.Element | null {
  const { t } = useTexts();
  const queries = useQueryClient();
  const agree = useMutation({
    mutationFn: (pose: AgreedPose) => performers.agree(nameOf(performer), pose),
    onSuccess: (all) => queries.setQueryData(performersQuery.queryKey, all),
  });
  if (!usePermissions()("agreePose")) return null;
  const poses: readonly AgreedPose[] = [
    "standing",
    "t_pose",
    ...(performer.is_t_pose_shown ? (["as_sent"] as const) : []),
  ];
  return (
    <>
      {agree.isError && <Failure error={agree.error} />}
      <Menu position="bottom-end" width={340}>
        <Menu.Target>
          <Button size="xs" variant="default" disabled={!isReady} loading={agree.isPending}>
            {t("performer.pose")}
          </Button>
        </Menu.Target>
        <Menu.Dropdown>
          {poses.map((pose) => (
            <Menu.Item key={pose} onClick={() => agree.mutate(pose)}>
              {t(`performer.pose.${pose}`)}
              <span className={classes.hint}>{t(`performer.pose.${pose}.hint`)}</span>
            </Menu.Item>
          ))}
        </Menu.Dropdown>
      </Menu>
    </>
  );
}

interface RecordProps extends WatchPanelProps {
  readonly onStored: (stored: Stored | null) => void;
}

/** One button: it begins a recording, then ends and stores it, with its time beside it. */
function Record({ performer, recording, onStored }: RecordProps): JSX.Element | null {
  const { t } = useTexts();
  const queries = useQueryClient();
  const record = useMutation({
    mutationFn: () => performers.record(nameOf(performer)),
    onSuccess: () => onStored(null),
    // Until the recording is known, the button would begin another one.
    onSettled: () => queries.invalidateQueries({ queryKey: performersQuery.queryKey }),
  });
  const store = useStoring(titleOf(performer), onStored);
  if (!usePermissions()("recordPerformer")) return null;
  if (recording === undefined) {
    return (
      <>
        {record.isError && <Failure error={record.error} />}
        <Button
          size="xs"
          disabled={performer.state === "gathering"}
          loading={record.isPending}
          onClick={() => record.mutate()}
        >
          {t("performer.record")}
        </Button>
      </>
    );
  }
  const isRunning = recording.state === "running";
  return (
    <>
      {store.isError && <Failure error={store.error} />}
      <span className={`${classes.time} numbers`}>
        <span className={`${classes.dot} ${isRunning ? classes.running : ""}`} aria-hidden />
        {duration(seconds(recording.duration_s))}
      </span>
      <StoreButton recording={recording} store={store} />
    </>
  );
}
