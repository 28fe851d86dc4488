/** One phase on the stage: what happened in it, what moved, and how it is drawn. */
import type { Replay, ReplayMovement } from "@shared/api/replays";
import type { Block } from "@shared/stage/blocks";
import type { Figure } from "@shared/stage/figure";
import type { PointMotion } from "@shared/stage/motion";
import { useQuery } from "@tanstack/react-query";
import { useMemo } from "react";
import { AVATAR_MAP, rolesFrom } from "../captures/bodyJoints";
import type { PhaseRef } from "./address";
import { type Happening, happenings } from "./happened";
import { movementQuery, replayQuery } from "./queries";

export interface Lane {
  readonly ref: PhaseRef;
  readonly label: string;
  readonly replay: Replay;
  readonly movement: ReplayMovement | null;
  /** Why there is no movement to draw although some is stored. */
  readonly error: Error | null;
  readonly retry: () => void;
  readonly all: readonly Happening[];
}

const NOWHERE: PhaseRef = { session: "", phase: -1 };

export function useLane(ref: PhaseRef | null, label: string) {
  const replay = useQuery({ ...replayQuery(ref ?? NOWHERE), enabled: ref !== null });
  const movement = useQuery({
    ...movementQuery(ref ?? NOWHERE, replay.data?.view ?? ""),
    enabled: ref !== null && replay.data?.has_movement === true,
  });
  const lane = useMemo((): Lane | null => {
    if (ref === null || replay.data === undefined) return null;
    return {
      ref,
      label,
      replay: replay.data,
      movement: movement.data ?? null,
      error: movement.error,
      retry: () => void movement.refetch(),
      all: happenings(replay.data),
    };
  }, [ref, label, replay.data, movement.data, movement.error, movement.refetch]);
  return { lane, error: replay.error };
}

const person = (key: string, motion: PointMotion, tone: Figure["tone"]): Figure => ({
  key,
  motion,
  tone,
  roles: rolesFrom(motion.names, AVATAR_MAP),
});

/** The avatar, with the participant as its ghost; the participant alone where there is no more. */
export function useFiguresOf(
  { movement }: Pick<Lane, "movement">,
  ghost: boolean,
): readonly Figure[] {
  return useMemo(() => {
    if (movement === null) return [];
    const { participant, avatar } = movement;
    if (avatar === null) return [person("participant", participant, "solid")];
    const body = person("avatar", avatar, "solid");
    return ghost ? [body, person("participant", participant, "ghost")] : [body];
  }, [movement, ghost]);
}

export function useBlocksOf({ replay }: Lane): readonly Block[] {
  return useMemo(
    () =>
      replay.surfaces.map(({ key, kind, center_m, half_size_m }) => ({
        key,
        wall: kind === "side",
        center: center_m,
        halfSize: half_size_m,
      })),
    [replay.surfaces],
  );
}
