/** What is chosen on the page, and how it reaches the simulation. */
import { type CaptureListed, captures } from "@shared/api/captures";
import { useQuery } from "@tanstack/react-query";
import { useEffect, useMemo, useRef, useState } from "react";
import { capturesQuery } from "../../captures/queries";
import type { Vector } from "./physics/commands";
import { DIRECTIONS, scaled } from "./pulling";
import {
  driveCommand,
  dropCommand,
  FIRST_PUSH,
  firstDrive,
  limitsOf,
  type PoseName,
  poseCommand,
  pushCommand,
} from "./settings";
import { type AvatarFile, captureOf } from "./source";
import { useRunState } from "./useRunState";
import type { LiveTryout } from "./useTryout";

const isPlayable = (one: CaptureListed): boolean => one.has_skeleton;

export type Commands = ReturnType<typeof useCommands>;

export function useCommands(
  live: LiveTryout,
  configuration: AvatarFile,
  axis: string,
  statureCm: number,
) {
  const { run } = live;
  const limits = limitsOf(configuration, axis);
  const [drive, setDrive] = useState(() => firstDrive(limits));
  const [pose, setPose] = useState<PoseName>("t");
  const [captureId, setCapture] = useState<string | null>(null);
  const [push, setPush] = useState(FIRST_PUSH);
  const [pushedN, setPushed] = useState<Vector>([0, 0, 0]);
  const [latencyMs, setLatency] = useState(0);
  const [hasGravity, setGravity] = useState(configuration.gravity);
  const driven = useRef(axis);
  if (driven.current !== axis) {
    driven.current = axis;
    setDrive(firstDrive(limits));
  }
  const listed = useQuery(capturesQuery);
  const motion = useQuery({
    queryKey: ["captures", captureId, "tryout", statureCm],
    queryFn: () => captures.onAvatar(captureId ?? "", `${statureCm}cm`, false),
    enabled: captureId !== null,
    staleTime: Number.POSITIVE_INFINITY,
  });
  const played = useMemo(
    () => (captureId === null || motion.data === undefined ? null : captureOf(motion.data)),
    [captureId, motion.data],
  );
  useEffect(() => {
    run?.send(played === null ? driveCommand(axis, drive) : { kind: "play", capture: played });
  }, [run, axis, drive, played]);
  useEffect(() => run?.send(poseCommand(pose)), [run, pose]);
  useEffect(() => run?.send({ kind: "latency", latencyS: latencyMs / 1000 }), [run, latencyMs]);
  useEffect(() => run?.send({ kind: "gravity", isOn: hasGravity }), [run, hasGravity]);
  useEffect(() => run?.aim(push.part), [run, push.part]);
  const go = () => {
    if (run === null) return;
    setPushed(scaled(DIRECTIONS[push.direction], push.forceN));
    run.send(pushCommand(push));
  };
  const drop = () => {
    const places = run?.progress[0]?.places;
    if (run === null || places === undefined) return;
    run.send(dropCommand(push.part, run.state.shapes[0] ?? [], places));
  };
  const state = useRunState(run);
  return {
    pushedN,
    movement: {
      drive,
      onDrive: setDrive,
      pose,
      onPose: setPose,
      captures: (listed.data?.captures ?? []).filter(isPlayable),
      capture: captureId,
      onCapture: setCapture,
      hasNoCaptures: listed.data !== undefined && !listed.data.captures.some(isPlayable),
      loading: {
        isLoading: captureId !== null && motion.isFetching,
        error: captureId === null ? null : motion.error,
        isUnusable: captureId !== null && motion.data !== undefined && played === null,
      },
    },
    disturbance: { push, onPush: setPush, go, drop },
    conditions: {
      latencyMs,
      longestMs: Math.floor(1000 * (state?.longestLatencyS ?? 0)),
      onLatency: setLatency,
      hasGravity,
      onGravity: setGravity,
    },
  };
}
