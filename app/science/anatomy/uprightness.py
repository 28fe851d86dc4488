"""Find captures that stand on their head or lie down because their upward axis was misread.

Few formats say which axis is up, and a world whose y or z points down (depth cameras, computer
vision) is not rare. People who stand, walk or reach have their hips above their ankles and their
neck above their hips: on the shared captures the line between them is 4 to 15 degrees from the
vertical for legs and up to 55 for trunks, in the median over the frames.

A person upside down in nearly every frame is turned over, by half a turn about x, which keeps left
and right as they are. One who lies in half of the frames may really lie: that is said.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from app.science.anatomy.notice import Notice
from app.science.rig import BodyMotion, MarkerMotion, RigMotion
from app.science.rotations import FloatArray, multiply

_LYING_DEG = 65.0
_UPSIDE_DOWN_DEG = 120.0
_NEARLY_ALWAYS = 0.95
# Half a turn about x, q p conj(q): y and z change their sign, of vectors and of rotations.
_HALF_TURN = np.array((0.0, 1.0, 0.0, 0.0))
_OVER, _OVER_ROTATION = np.array((1.0, -1.0, -1.0)), np.array((1.0, 1.0, -1.0, -1.0))


def tilts_deg(places_m: Mapping[str, FloatArray]) -> FloatArray:
    """Return how far the body is from upright in each frame, (N,) degrees; empty if unknown.

    Legs decide, from the ankles to the hips; without them the trunk, from the hips to the neck.
    Frames in which a joint is unknown are left out.

    Args:
        places_m: body joint -> positions (N, 3) in the world, y up, NaN where unknown.
    """
    if {"Hips", "LeftFoot", "RightFoot"} <= set(places_m):
        ankles = 0.5 * (places_m["LeftFoot"] + places_m["RightFoot"])
        return _from_vertical_deg(places_m["Hips"] - ankles)
    if {"Hips", "Neck"} <= set(places_m):
        return _from_vertical_deg(places_m["Neck"] - places_m["Hips"])
    return np.empty(0)


def upright_notice(tilt_deg: FloatArray) -> Notice | None:
    """Return a notice on a body that is not upright: `mended` if it has to be turned over.

    Args:
        tilt_deg: see `tilts_deg`.
    """
    if len(tilt_deg) == 0:
        return None
    median = float(np.median(tilt_deg))
    if median <= _LYING_DEG:
        return None
    found = f"the body's up is {median:.0f} degrees from the capture's in the median"
    valid = f"at most {_LYING_DEG:.0f} degrees for people who stand, walk or sit"
    if float(np.mean(tilt_deg > _UPSIDE_DOWN_DEG)) >= _NEARLY_ALWAYS:
        return Notice(
            "upright",
            "mended",
            "The body is upside down, as from an axis that points down: it was turned over.",
            found,
            valid,
            "If the person really stood on the hands throughout, cut the capture so that it also"
            " shows them standing.",
        )
    return Notice(
        "upright",
        "noted",
        "The body lies or is upside down: the upward axis may be another one.",
        found,
        valid,
        "If the person stands, give the upward axis: --up x, y or z, or in the settings of the"
        " capture. Heights, steps and the floor mean nothing until then.",
    )


def turned_over_markers(motion: MarkerMotion) -> MarkerMotion:
    """Return markers turned by half a turn about x, so that down becomes up."""
    return replace(motion, positions_m=motion.positions_m * _OVER)


def turned_over_bodies(motion: BodyMotion) -> BodyMotion:
    """Return rigid bodies turned by half a turn about x; see `turned_over_markers`."""
    positions, rotations = motion.positions_m * _OVER, motion.rotations * _OVER_ROTATION
    return replace(motion, positions_m=positions, rotations=rotations)


def turned_over_skeleton(motion: RigMotion, *, rest_is_upright: bool) -> RigMotion:
    """Return a skeleton's movement turned by half a turn about x; see `turned_over_markers`.

    Args:
        motion: the movement of a body upside down.
        rest_is_upright: whether the rest pose stands on its feet: then only the root is turned.
            Else the axes of every frame are, as where a file's upward axis is chosen.
    """
    if rest_is_upright:
        rotations = motion.rotations.copy()
        rotations[:, 0] = multiply(_HALF_TURN, rotations[:, 0])
        root = motion.root_positions_m * _OVER
        return replace(motion, root_positions_m=root, rotations=rotations)
    rig = replace(
        motion.rig,
        offsets_m=motion.rig.offsets_m * _OVER,
        rest_rotations=motion.rig.rest_rotations * _OVER_ROTATION,
        ends=tuple((joint, (x, -y, -z)) for joint, (x, y, z) in motion.rig.ends),
    )
    return replace(
        motion,
        rig=rig,
        root_positions_m=motion.root_positions_m * _OVER,
        rotations=motion.rotations * _OVER_ROTATION,
    )


def _from_vertical_deg(up: FloatArray) -> FloatArray:
    sizes = np.linalg.norm(up, axis=1)
    known = np.isfinite(sizes) & (sizes > 0.0)
    cosines = up[known, 1] / sizes[known]
    return np.asarray(np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0))))
