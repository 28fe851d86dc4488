/**
 * The figures on the stage: the capture as recorded, its skeleton, or an avatar next to its source.
 */
import type { Capture } from "@shared/api/captures";
import { type Figure, facingOf } from "@shared/stage/figure";
import type { PointMotion } from "@shared/stage/motion";
import { placing } from "@shared/stage/placing";
import { seconds } from "@shared/units";
import { useQuery } from "@tanstack/react-query";
import { useMemo } from "react";
import { AVATAR_MAP, rolesFrom } from "./bodyJoints";
import { avatarMotionQuery, motionQuery } from "./queries";
import type { JointMapDraft } from "./useJointMap";

export interface StageOptions {
  readonly shown: "recorded" | "skeleton" | "avatar";
  readonly avatar: string;
  readonly lockFeet: boolean;
  readonly ghost: boolean;
}

/** Far enough apart for two people with their arms spread. */
const OFFSET_M = 1.3;

export function useFigures(capture: Capture, wish: StageOptions, map: JointMapDraft) {
  const isAvatar = wish.shown === "avatar";
  const version = map.view?.version ?? 0;
  const source = useQuery({
    ...motionQuery(capture, wish.shown === "recorded" ? "recorded" : "skeleton"),
    enabled: !isAvatar || wish.ghost,
  });
  const avatar = useQuery({
    ...avatarMotionQuery(capture, wish.avatar, wish.lockFeet, version),
    enabled: isAvatar && map.view !== undefined,
  });
  const jointMap = map.view?.joint_map;
  const sourceFigure = useMemo(
    () => (source.data === undefined ? null : sourceOf(source.data, jointMap)),
    [source.data, jointMap],
  );
  const figures = useMemo((): readonly Figure[] => {
    if (!isAvatar) return sourceFigure === null ? [] : [sourceFigure];
    if (avatar.data === undefined) return [];
    const body = avatarFigure(avatar.data);
    const ghost = wish.ghost && sourceFigure !== null ? [ghostOf(sourceFigure, body)] : [];
    return [body, ...ghost];
  }, [isAvatar, sourceFigure, avatar.data, wish.ghost]);
  const query = isAvatar ? avatar : source;
  return { figures, query, error: query.error, busy: query.isPlaceholderData || query.isPending };
}

export function sourceOf(
  motion: PointMotion,
  map: Readonly<Record<string, string>> | undefined,
): Figure {
  const plain: Figure = { key: "source", motion, tone: "solid" };
  // Markers and rigid bodies are not joints, even if one has a joint's name.
  if (map === undefined || motion.kind !== "skeleton") return plain;
  return { ...plain, roles: rolesFrom(motion.names, map) };
}

const avatarFigure = (motion: PointMotion): Figure => ({
  key: "avatar",
  motion,
  tone: "solid",
  roles: rolesFrom(motion.names, AVATAR_MAP),
});

/** The source at the avatar's left hand. */
function ghostOf(source: Figure, avatar: Figure): Figure {
  const start = placing(avatar);
  start.place(seconds(0));
  const [x, z] = facingOf(avatar, start.placed) ?? [0, -1];
  return { ...source, tone: "ghost", offset: [OFFSET_M * z, -OFFSET_M * x] };
}
