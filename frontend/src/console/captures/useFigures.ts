/**
 * The figures on the stage: the capture as recorded, its skeleton, or an avatar next to its source.
 */
import type { Capture } from "@shared/api/captures";
import { type Figure, facingOf } from "@shared/stage/figure";
import type { PointMotion } from "@shared/stage/motion";
import { placing } from "@shared/stage/placing";
import type { BodyModel } from "@shared/stage/skin/bodyModel";
import { seconds } from "@shared/units";
import { useQuery } from "@tanstack/react-query";
import { useMemo, useState } from "react";
import { useBodyChoice } from "../bodyView/BodyChoice";
import { useBody } from "../bodyView/useBody";
import { wornBy } from "../bodyView/worn";
import { statureOf } from "./avatars";
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
  const choice = useBodyChoice(isAvatar);
  const worn = useBody(isAvatar ? choice.hash : null);
  const version = map.view?.version ?? 0;
  const source = useQuery({
    ...motionQuery(capture, wish.shown === "recorded" ? "recorded" : "skeleton"),
    enabled: !isAvatar || wish.ghost,
  });
  const avatar = useQuery({
    ...avatarMotionQuery(capture, wish.avatar, wish.lockFeet, version),
    enabled: isAvatar && map.view !== undefined,
  });
  // While another avatar is computed, the previous one is shown in its own size.
  const shownAvatar = useShown(wish.avatar, avatar.isPlaceholderData);
  const jointMap = map.view?.joint_map;
  const sourceFigure = useMemo(
    () => (source.data === undefined ? null : sourceOf(source.data, jointMap)),
    [source.data, jointMap],
  );
  const figures = useMemo((): readonly Figure[] => {
    if (!isAvatar) return sourceFigure === null ? [] : [sourceFigure];
    if (avatar.data === undefined) return [];
    const body = avatarFigure(avatar.data, worn.model, statureOf(shownAvatar) / 100);
    const ghost = wish.ghost && sourceFigure !== null ? [ghostOf(sourceFigure, body)] : [];
    return [body, ...ghost];
  }, [isAvatar, sourceFigure, avatar.data, wish.ghost, worn.model, shownAvatar]);
  const query = isAvatar ? avatar : source;
  const busy = query.isPlaceholderData || query.isPending;
  return { figures, query, error: query.error, busy, choice, worn };
}

/** The last value that was not held back. */
function useShown<T>(value: T, isHeldBack: boolean): T {
  const [shown, setShown] = useState(value);
  if (!isHeldBack && shown !== value) setShown(value);
  return isHeldBack ? shown : value;
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

const avatarFigure = (motion: PointMotion, model: BodyModel | null, statureM: number): Figure => ({
  key: "avatar",
  motion,
  tone: "solid",
  roles: rolesFrom(motion.names, AVATAR_MAP),
  ...wornBy(motion, model, statureM),
});

/** The source at the avatar's left hand. */
function ghostOf(source: Figure, avatar: Figure): Figure {
  const start = placing(avatar);
  start.place(seconds(0));
  const [x, z] = facingOf(avatar, start.placed) ?? [0, -1];
  return { ...source, tone: "ghost", offset: [OFFSET_M * z, -OFFSET_M * x] };
}
