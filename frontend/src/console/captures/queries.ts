/** The queries of captures. Everything of one capture is cached under its id. */
import { type Capture, captures, type MotionView, type ReadingChoice } from "@shared/api/captures";
import { keepPreviousData, queryOptions } from "@tanstack/react-query";

export const capturesQuery = queryOptions({ queryKey: ["captures"], queryFn: captures.list });

export const captureQuery = (id: string) =>
  queryOptions({ queryKey: ["captures", id], queryFn: () => captures.get(id) });

/** A file never changes, but its reading may, so the reading is part of the cache key. */
const readingKey = ({ metres_per_unit, up }: ReadingChoice) => `${metres_per_unit} ${up}`;

export const motionQuery = (capture: Capture, shown: MotionView) =>
  queryOptions({
    queryKey: ["captures", capture.id, "motion", shown, readingKey(readingOf(capture))],
    queryFn: () => captures.motion(capture.id, shown),
    staleTime: Number.POSITIVE_INFINITY,
    placeholderData: keepPreviousData,
  });

/** The query of the movement on an avatar. `map` is the version of the joint map: another version moves the avatar differently. */
export const avatarMotionQuery = (
  capture: Capture,
  avatar: string,
  lockFeet: boolean,
  map: number,
) =>
  queryOptions({
    queryKey: [
      ...["captures", capture.id, "avatar", avatar, lockFeet],
      ...[map, readingKey(readingOf(capture))],
    ],
    queryFn: () => captures.onAvatar(capture.id, avatar, lockFeet),
    staleTime: Number.POSITIVE_INFINITY,
    placeholderData: keepPreviousData,
  });

export const jointMapQuery = (id: string) =>
  queryOptions({ queryKey: ["captures", id, "joint-map"], queryFn: () => captures.jointMap(id) });

export const verificationQuery = (
  capture: Capture,
  avatars: readonly string[],
  lockFeet: boolean,
  map: number,
) =>
  queryOptions({
    queryKey: [
      ...["captures", capture.id, "verification", avatars.join(" "), lockFeet],
      ...[map, readingKey(readingOf(capture))],
    ],
    queryFn: () => captures.verification(capture.id, avatars, lockFeet),
    staleTime: Number.POSITIVE_INFINITY,
    placeholderData: keepPreviousData,
  });

export const readingOf = ({ reading }: Capture): ReadingChoice => ({
  metres_per_unit: reading.metres_per_unit ?? null,
  up: reading.up ?? null,
});
