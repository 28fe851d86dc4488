"""Check by anatomy a skeleton that a file contains, and the walk that comes of it.

Skeletons of files are transferred by their joints' rotations, so their lengths matter only for
scale: what does not fit is noted. Up and down, left and right do matter: a skeleton upside down is
turned over, since its feet would hang from the ceiling. A mirrored one faces backwards, and its
feet would swing from the wrong side of the ankle (step heights of 2.5 to 3.6 times the source's
were seen). It is mirrored back. One foot that points backwards cannot be mended without guessing.
"""

from collections.abc import Mapping

import numpy as np

from app.science.anatomy import (
    PUBLISHED,
    Handedness,
    Notice,
    backward_foot_notice,
    frozen_notice,
    handedness_of,
    jump_notice,
    knees_agreeing,
    length_notices,
    mirrored_notice,
    mirrored_skeleton,
    repeated,
    segment_lengths,
    tilts_deg,
    turned_over_skeleton,
    upright_notice,
)
from app.science.retargeting.joint_map import JointMap
from app.science.retargeting.legs import has_ball, has_legs, legs_of
from app.science.rig import RigMotion
from app.science.rotations import FloatArray

_LOWEST_RATIO, _HIGHEST_RATIO = 0.5, 2.0
_LOWEST_STEP_M = 0.02
_LOWEST_STATURE_M, _HIGHEST_STATURE_M = 0.5, 2.6
_SMALLEST_WALKER_M = 0.85
"""Smaller people hardly walk; the same limit as for the guess of a file's unit."""
_ADULT_M = (1.4, 2.1)
_CM_PER_INCH = 2.54
_CLEARLY = 0.2
"""Cosine between foot and front from which a foot clearly points forwards, or backwards."""
_SIDES_RATIO = 1.7
"""Ratio of both sides' mean step heights from which they are noted; captured walks had 1.3."""
_FEWEST_STRIDES = 2
"""Strides of one side between which there is a whole one of the other, if it walks."""
_BACKWARDS = 0.2
"""Share of the frames in which a knee bends forwards below which it bends backwards."""
_STIFF_DEG, _BENT_DEG = 1.0, 20.0
"""Changes of a knee's angle: at most, of one that never moves; at least, of one that does."""
_HIGHEST_STEP_M = 0.4
"""Higher lifts are dance or climbing, whose sides may differ."""


def checked_skeleton(
    motion: RigMotion, joint_map: JointMap, *, names_map: JointMap | None = None
) -> tuple[RigMotion, tuple[Notice, ...]]:
    """Return a file's movement upright, with left and right as people have them, and notices.

    Args:
        motion: as read from the file.
        joint_map: body joint -> joint of its rig.
        names_map: the map that follows from the joints' names, where `joint_map` is somebody's own:
            only what the file calls left can be mirrored back. A map of one's own that exchanges
            the sides is refused with the walk (`sides_notice`).
    """
    pose, root = repeated(motion.rotations[:, 1:]), repeated(motion.root_positions_m)
    frozen = frozen_notice({"the pose": pose, "the root's position": root}, motion.rate_hz)
    over_time = (frozen, jump_notice(motion.root_positions_m, motion.rate_hz))
    notices = [notice for notice in over_time if notice is not None]
    upright = upright_notice(tilts_deg(_places(motion, joint_map)))
    if upright is not None:
        notices.append(upright)
    if upright is not None and upright.action == "mended":
        at_rest, _ = motion.rig.rest_world()
        places = {part: at_rest[[motion.rig.index(name)]] for part, name in joint_map.items()}
        motion = turned_over_skeleton(motion, rest_is_upright=not upright_notice(tilts_deg(places)))
    votes = _votes(motion, joint_map if names_map is None else names_map)
    if votes.is_mirrored:
        notices.append(mirrored_notice(_shares(votes), "more than 20 %"))
        motion = mirrored_skeleton(motion)
    rest, _ = motion.rig.rest_world()
    places = {part: rest[motion.rig.index(name)] for part, name in joint_map.items()}
    lengths = segment_lengths(places)
    return motion, (*notices, *length_notices(lengths))


def sides_notice(motion: RigMotion, joint_map: JointMap) -> Notice | None:
    """Return a refusal if a map names the sides of a body the wrong way round."""
    votes = _votes(motion, joint_map)
    if not votes.is_mirrored:
        return None
    return Notice(
        "mirrored",
        "refused",
        "The joint map exchanges left and right: the avatar would face backwards.",
        _shares(votes),
        "more than 20 %",
        "Exchange left and right in the map. If the map is right, the file has left-handed axes:"
        " export it with right-handed ones.",
    )


def knee_notice(motion: RigMotion, joint_map: JointMap) -> Notice | None:
    """Return a notice if one knee bends backwards or never, while the other one bends forwards."""
    places = _places(motion, joint_map)
    forwards, bends = knees_agreeing(places), _knee_ranges_deg(places)
    if forwards and min(forwards.values()) < _BACKWARDS < 1.0 - _BACKWARDS < max(forwards.values()):
        what = "One knee bends backwards, as nobody's does."
        value = [f"forwards in {100.0 * one:.0f} % {side}" for side, one in forwards.items()]
    elif bends and min(bends.values()) < _STIFF_DEG < _BENT_DEG < max(bends.values()):
        what = "One knee never moves, while the other one bends."
        value = [f"bends by {one:.1f} degrees {side}" for side, one in bends.items()]
    else:
        return None
    return Notice(
        "knees",
        "noted",
        what,
        ", ".join(value),
        "both knees bend forwards",
        "Check the names and channels of that leg in the file, and which joints are mapped to it."
        " If the person wears an orthosis, it may be right.",
    )


def _knee_ranges_deg(places_m: Mapping[str, FloatArray]) -> dict[str, float]:
    """Return by how many degrees the angle of each knee changes, by side."""
    found = {}
    for side in ("Left", "Right"):
        names = [f"{side}{part}" for part in ("UpperLeg", "LowerLeg", "Foot")]
        if all(name in places_m for name in names):
            hip, knee, ankle = (places_m[name] for name in names)
            sizes = np.linalg.norm(hip - knee, axis=1) * np.linalg.norm(ankle - knee, axis=1)
            cosines = np.einsum("ni,ni->n", hip - knee, ankle - knee) / np.maximum(sizes, 1e-9)
            found[side.lower()] = float(np.ptp(np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0)))))
    return found


def foot_notice(motion: RigMotion, joint_map: JointMap) -> Notice | None:
    """Return a refusal if one foot of a body points backwards: its heel and toes are exchanged.

    The body's front is up x right, as for `handedness_of`. Feet without a ball are no evidence.
    """
    if not has_legs(joint_map) or not has_ball(motion.rig, joint_map):
        return None
    legs = legs_of(motion.rig, joint_map)
    positions, world = motion.world()
    hips = positions[:, [leg.thigh for leg in legs.both]]
    knees = positions[:, [leg.shin for leg in legs.both]]
    front = np.cross((hips - knees).mean(axis=1), hips[:, 1] - hips[:, 0])
    forwards = {
        leg.side: _median_cosine(leg.ball_m(positions, world) - positions[:, leg.foot], front)
        for leg in legs.both
    }
    side = min(forwards, key=lambda one: forwards[one])
    if not forwards[side] < -_CLEARLY < _CLEARLY < max(forwards.values()):
        return None
    return backward_foot_notice(side, f"{np.degrees(np.arccos(forwards[side])):.0f} degrees")


def _median_cosine(vectors: FloatArray, others: FloatArray) -> float:
    sizes = np.linalg.norm(vectors, axis=1) * np.linalg.norm(others, axis=1)
    cosines = np.einsum("ni,ni->n", vectors, others) / np.maximum(sizes, 1e-9)
    return float(np.clip(np.median(cosines), -1.0, 1.0))


def _votes(motion: RigMotion, joint_map: JointMap) -> Handedness:
    return handedness_of(_places(motion, joint_map))


def _places(motion: RigMotion, joint_map: JointMap) -> dict[str, FloatArray]:
    positions, _ = motion.world()
    return {part: positions[:, motion.rig.index(name)] for part, name in joint_map.items()}


def _shares(votes: Handedness) -> str:
    shares = [f"{100.0 * share:.0f} % of the {kind}" for kind, share in votes.agreeing.items()]
    return f"{', '.join(shares)} agree with the names of left and right"


def toes_notice(motion: RigMotion, joint_map: JointMap) -> Notice | None:
    """Return a notice if a body with legs has no toes, so that its ball is estimated."""
    if not has_legs(joint_map) or has_ball(motion.rig, joint_map):
        return None
    return Notice(
        "toes",
        "mended",
        "The feet have no toes: steps are measured where the ball of such a foot is.",
        "no toe joint and no end of the foot, or at the ankle itself",
        "a toe joint or an end on each foot, 2.5 % of the leg or farther from the ankle",
        "Map the toes if the skeleton has them; a foot's own length is not known otherwise.",
    )


def stature_notice(leg_length_m: float | None) -> Notice | None:
    """Return a notice if legs are so long or short that nobody has them: the unit may be wrong.

    An avatar moves the same at any unit, since its travel is scaled by the legs; all figures of the
    source are wrong.
    """
    if leg_length_m is None:
        return None
    stature_m = leg_length_m / (PUBLISHED["thigh"] + PUBLISHED["shank"])
    if _SMALLEST_WALKER_M <= stature_m <= _HIGHEST_STATURE_M:
        return None
    small = _LOWEST_STATURE_M <= stature_m < _SMALLEST_WALKER_M
    lowest_m = _SMALLEST_WALKER_M if small else _LOWEST_STATURE_M
    return Notice(
        "length",
        "noted",
        "The person's size is not a human's: the file's unit of length may be wrong, and with it"
        " every length and speed of the capture.",
        f"legs of {leg_length_m:.3g} m, as of a stature of {stature_m:.3g} m",
        f"a stature of {lowest_m} to {_HIGHEST_STATURE_M} m{_if_inches(stature_m)}",
        "Give the unit: --unit with metres per unit, or in the settings of the capture.",
    )


def _if_inches(stature_m: float) -> str:
    """Name the commonest mistake, inches taken for centimetres or the reverse, if it fits."""
    for taken, meant, other_m in (
        ("centimetres", "inches", stature_m * _CM_PER_INCH),
        ("inches", "centimetres", stature_m / _CM_PER_INCH),
    ):
        if _ADULT_M[0] <= other_m <= _ADULT_M[1]:
            return (
                f" (it would be {other_m:.2f} m if numbers read as {taken} are {meant}, a factor"
                f" of {_CM_PER_INCH})"
            )
    return ""


def uneven_steps_notice(left_m: float | None, right_m: float | None) -> Notice | None:
    """Return a notice if the mean step heights of both sides differ by more than people's do.

    Steps of less than 2 cm on both sides are shuffles, whose ratio means nothing; lifts of more
    than 40 cm are no walk.
    """
    if left_m is None or right_m is None:
        return None
    if not _LOWEST_STEP_M <= max(left_m, right_m) <= _HIGHEST_STEP_M:
        return None
    if max(left_m, right_m) <= _SIDES_RATIO * min(left_m, right_m):
        return None
    return Notice(
        "step_height",
        "noted",
        "The steps of one side are much higher than those of the other.",
        f"{100.0 * left_m:.1f} cm left, {100.0 * right_m:.1f} cm right, on average",
        f"at most {_SIDES_RATIO} times as high on one side",
        "If the person did not limp or step onto something, check the labels of heels and toes and"
        " which joints are mapped to feet and toes.",
    )


def one_sided_notice(left: int, right: int) -> Notice | None:
    """Return a notice if only one side makes strides; `left` and `right` are their numbers."""
    if min(left, right) > 0 or max(left, right) < _FEWEST_STRIDES:
        return None
    return Notice(
        "step_height",
        "noted",
        "Only one leg makes strides.",
        f"{left} strides left, {right} right",
        "strides of both legs, in turns",
        "Check the names and channels of the other leg, and which joints are mapped to its foot.",
    )


def step_height_notice(
    source_m: float | None, avatar_m: float | None, leg_ratio: float
) -> Notice | None:
    """Return a refusal if mean step heights do not scale with the legs, None where they do.

    Steps of less than 2 cm are shuffles, whose ratio means nothing.
    """
    if source_m is None or avatar_m is None or source_m < _LOWEST_STEP_M:
        return None
    ratio = avatar_m / source_m / leg_ratio
    if _LOWEST_RATIO <= ratio <= _HIGHEST_RATIO:
        return None
    return Notice(
        "step_height",
        "refused",
        "The avatar's steps do not have the person's height: joints are not where they are named.",
        f"{avatar_m / source_m:.2f} times the source's height for {leg_ratio:.2f} times its legs",
        f"{_LOWEST_RATIO * leg_ratio:.2f} to {_HIGHEST_RATIO * leg_ratio:.2f} times",
        "Check which joints are mapped to feet and toes, and the capture's axes.",
    )
