"""Tracks on the floor from any capture: skeletons, trackers on a belt, markers.

The world's (x, y, z), y up, is the floor's (x, -z): x to the right, y ahead.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from app.science.rig import BodyMotion, MarkerMotion, RigMotion
from app.science.rotations import FloatArray, rotate
from app.science.walking.recording.centre_of_mass import centre_of_mass
from app.science.walking.records import Kind, Track, WalkingError

LONGEST_GAP_S = 0.1
"""A longer gap is not filled, because a person may turn in it."""
TORSO_DEPTH_M = 0.24
"""Depth of an adult's trunk at the navel, used if it was not measured."""


@dataclass(frozen=True)
class Walker:
    """The captured person and the source of the capture, as stored with every track."""

    subject: str
    source: str
    stature_m: float | None = None
    kind: Kind = "human"


def on_floor(world_m: FloatArray) -> FloatArray:
    """Return the positions (..., 2) on the floor of points (..., 3) in the world."""
    return np.stack([world_m[..., 0], -world_m[..., 2]], axis=-1)


def track_of_points(times_s: FloatArray, xy_m: FloatArray, walker: Walker) -> Track:
    """Make a track of positions (N, 2); NaN marks samples that were not seen.

    Unseen samples at the beginning and at the end are cut off, short gaps are interpolated
    linearly.

    Raises:
        WalkingError: fewer than two positions were seen, or a gap is longer than `LONGEST_GAP_S`.
    """
    times_s, xy_m = bridged(times_s, xy_m, f"The track of {walker.subject!r} ({walker.source})")
    return Track(times_s, xy_m, walker.subject, walker.source, walker.kind, walker.stature_m)


def track_of_rig(
    motion: RigMotion,
    joint_map: Mapping[str, str],
    walker: Walker,
    follow: Literal["centre of mass", "hips"] = "centre of mass",
) -> Track:
    """Make a track of a skeleton's centre of mass, or of its hips.

    Args:
        motion: the capture.
        joint_map: body joint -> rig joint, as `propose_joint_map` derives it from names.
        walker: the captured person.
        follow: the point of the body; for an upper body without legs only the hips are possible.

    Raises:
        WalkingError: joints that are needed are not mapped.
    """
    if follow == "hips":
        if "Hips" not in joint_map:
            raise WalkingError("The skeleton's hips are not mapped: name their joint.")
        positions, _ = motion.world()
        world_m = positions[:, motion.rig.index(joint_map["Hips"])]
    else:
        world_m = centre_of_mass(motion, joint_map)
    times_s = np.arange(motion.frame_count, dtype=np.float64) / motion.rate_hz
    return track_of_points(times_s, on_floor(world_m), walker)


def track_of_belt(
    motion: BodyMotion,
    body: str,
    walker: Walker,
    *,
    torso_depth_m: float = TORSO_DEPTH_M,
    off_skin_m: float = 0.0,
    inward: tuple[float, float, float] = (0.0, 0.0, 1.0),
) -> Track:
    """Make a track of the middle of the trunk from a tracker worn on a belt over the navel.

    Args:
        motion: the tracker's movement, possibly among others.
        body: the name of the tracker.
        walker: the person who wears it.
        torso_depth_m: front to back at the belt; half of it lies between skin and middle.
        off_skin_m: distance of the tracker's origin from the skin.
        inward: the tracker's own axis that points into the body, usually its z.

    Raises:
        WalkingError: there is no such body, a depth is invalid, or the tracker was out of sight for
            too long.
    """
    if body not in motion.names:
        raise WalkingError(f"No body {body!r} was tracked; there are {', '.join(motion.names)}.")
    if not 0.0 <= torso_depth_m < 1.0 or not 0.0 <= off_skin_m < 1.0:
        raise WalkingError(
            f"A torso {torso_depth_m} m deep and a tracker {off_skin_m} m off the skin: give metres"
            " between 0 and 1."
        )
    axis, at = np.array(inward, dtype=np.float64), motion.names.index(body)
    reach = (torso_depth_m / 2.0 + off_skin_m) * axis / np.linalg.norm(axis)
    world_m = motion.positions_m[:, at] + rotate(motion.rotations[:, at], reach)
    return track_of_points(motion.times_s, on_floor(world_m), walker)


def track_of_markers(motion: MarkerMotion, names: tuple[str, ...], walker: Walker) -> Track:
    """Make a track of the mean of several markers, such as the four of the pelvis.

    Raises:
        WalkingError: there is no marker of a name, or the markers were not all seen for too long.
    """
    unknown = [name for name in names if name not in motion.names]
    if unknown or not names:
        raise WalkingError(
            f"No marker {', '.join(unknown) or 'is named'}: there are {', '.join(motion.names)}."
        )
    chosen = [motion.names.index(name) for name in names]
    world_m = motion.positions_m[:, chosen].mean(axis=1)
    times_s = np.arange(motion.frame_count, dtype=np.float64) / motion.rate_hz
    return track_of_points(times_s, on_floor(world_m), walker)


def bridged(
    times_s: FloatArray, xy_m: FloatArray, what: str, longest_s: float = LONGEST_GAP_S
) -> tuple[FloatArray, FloatArray]:
    """Fill short gaps in positions (N, 2) linearly; `what` begins the message of an error.

    Raises:
        WalkingError: fewer than two positions were seen, or a gap is longer than `longest_s`.
    """
    seen = np.flatnonzero(np.isfinite(xy_m).all(axis=1))
    if len(seen) < 2:
        raise WalkingError(
            f"{what} has {len(seen)} position(s) that were seen; at least two are needed."
        )
    gaps = np.diff(times_s[seen])
    missed = np.flatnonzero((np.diff(seen) > 1) & (gaps > longest_s))
    if len(missed):
        at = int(missed[0])
        raise WalkingError(
            f"{what} was not seen for {gaps[at]:.2f} s from {times_s[seen[at]]:.2f} s on. Gaps up"
            f" to {longest_s:g} s are filled; for a longer gap, cut the recording there."
        )
    kept = slice(seen[0], seen[-1] + 1)
    columns = [np.interp(times_s[kept], times_s[seen], xy_m[seen, axis]) for axis in (0, 1)]
    return times_s[kept] - times_s[seen[0]], np.stack(columns, axis=-1)
