/** One phase on the stage: its events, its movement, and how it is drawn. */
import { type Replay, type ReplayMovement, replays } from "@shared/api/replays";
import type { SessionView } from "@shared/api/types";
import type { Block, Figure } from "@shared/stage/figure";
import { type BodyMarks, NO_MARKS } from "@shared/stage/marks";
import type { PointMotion } from "@shared/stage/motion";
import type { BodyModel } from "@shared/stage/skin/bodyModel";
import { queryOptions, useQuery } from "@tanstack/react-query";
import { useMemo } from "react";
import { hipsScaleOf, wornBy } from "../bodyView/worn";
import { AVATAR_MAP, rolesFrom } from "../captures/bodyJoints";
import { sessionQuery } from "../queries";
import { isOver, usePhaseName } from "../steps";
import type { PhaseRef } from "./address";
import { eventsOf, type ReplayEvent } from "./events";

export interface Lane {
  readonly ref: PhaseRef;
  readonly label: string;
  readonly replay: Replay;
  readonly movement: ReplayMovement | null;
  /** Why there is no movement to draw although some is stored. */
  readonly error: Error | null;
  readonly retry: () => void;
  readonly all: readonly ReplayEvent[];
}

const NOWHERE: PhaseRef = { session: "", phase: -1 };

export function useLane(ref: PhaseRef | null, label: string) {
  const replay = useQuery({ ...replayQuery(ref ?? NOWHERE), enabled: ref !== null });
  const movement = useQuery({
    ...movementQuery(ref ?? NOWHERE, replay.data),
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
      all: eventsOf(replay.data),
    };
  }, [ref, label, replay.data, movement.data, movement.error, movement.refetch]);
  return { lane, error: replay.error };
}

/** The avatar with the participant as its ghost, or the participant alone; in a body if given. */
export function useFiguresOf(
  { movement, replay }: { readonly movement: Lane["movement"]; readonly replay: Replay | null },
  ghost: boolean,
  model: BodyModel | null,
): readonly Figure[] {
  const statureM = replay?.stature_m ?? null;
  const settings = replay?.avatar_settings ?? UNCHANGED;
  return useMemo(() => {
    if (movement === null) return [];
    const { participant, avatar } = movement;
    const person = (
      key: string,
      motion: PointMotion,
      tone: Figure["tone"],
      hipsScale = 1,
    ): Figure => ({
      key,
      motion,
      tone,
      roles: rolesFrom(motion.names, AVATAR_MAP),
      // The display shows what the participant's head sees, whatever the avatar does.
      seenBy: participant,
      ...wornBy(motion, model, statureM, hipsScale),
    });
    if (avatar === null) return [person("participant", participant, "solid")];
    const marks = (time: number) => marksAt(settings, time);
    const body = {
      ...person("avatar", avatar, "solid"),
      ...(settings.length > 0 && { marks }),
    };
    if (!ghost) return [body];
    return [body, person("participant", participant, "ghost", hipsScaleOf(avatar, participant))];
  }, [movement, ghost, model, statureM, settings]);
}

const UNCHANGED: Replay["avatar_settings"] = [];

/** The marks of parts whose settings were changed, at a time of the phase. */
export function marksAt(settings: Replay["avatar_settings"], time: number): BodyMarks {
  const now = settings.findLast(({ t_s }) => t_s <= time);
  return now === undefined ? NO_MARKS : { cast: now.held_parts, passing: now.passing_parts };
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

/** The queries of a replay. The phase is over, so their answers hardly ever change. */
const replayQuery = ({ session, phase }: PhaseRef) =>
  queryOptions({
    queryKey: ["sessions", session, "replay", phase],
    queryFn: () => replays.get(session, phase),
    staleTime: 60_000,
    retry: false,
  });

const movementQuery = ({ session, phase }: PhaseRef, replay: Replay | undefined) =>
  queryOptions({
    queryKey: [
      ...["sessions", session, "replay", phase, "movement"],
      ...[replay?.view, replay?.humanoid],
    ],
    // Rotations are needed for a body with skin only.
    queryFn: () => replays.movement(session, phase, replay?.humanoid != null),
    staleTime: Number.POSITIVE_INFINITY,
    // Some megabytes each: the browser caches them too, and revalidates.
    gcTime: 60_000,
    retry: false,
  });

/** The phase to compare with, of this session or of another one of the study. */
export function useComparedPhase(session: SessionView, reference: PhaseRef | null) {
  const nameOf = usePhaseName();
  const isOther = reference !== null && reference.session !== session.id;
  const other = useQuery({ ...sessionQuery(reference?.session ?? ""), enabled: isOther });
  const source = isOther ? (other.data ?? null) : session;
  const phase = source?.phases.find(({ phase_id }) => phase_id === reference?.phase);
  const isReplayable = phase !== undefined && isOver(phase);
  const ref = isReplayable ? reference : null;
  const name = source === null || phase === undefined ? "" : nameOf(source, phase);
  return {
    ref,
    session: source ?? session,
    label: isOther && source !== null ? `${source.participant_code} · ${name}` : name,
  };
}
