"""Find the hands in a capture: bodies tracked on their own, or the joints of a skeleton."""

import re
from collections.abc import Mapping, Sequence

import numpy as np

from app.science.reaching.records import HandTrack, Reacher, ReachingError
from app.science.rig import BodyMotion, MarkerMotion, RigMotion
from app.science.rotations import FloatArray

_HAND = re.compile(r"hand|controller|touch|wrist|wand", re.IGNORECASE)
_SIDE = re.compile(r"^(left|right|l|r)$", re.IGNORECASE)
_TRUNK = re.compile(r"head|hmd|hips|pelvis", re.IGNORECASE)
_JOINTS = ("LeftHand", "RightHand")


def hand_tracks(
    motion: BodyMotion | MarkerMotion | RigMotion,
    who: Reacher,
    *,
    joint_map: Mapping[str, str] | None = None,
    named: str | None = None,
) -> list[HandTrack]:
    """Return the paths of the hands of a capture; hands that were never seen or moved have none.

    Args:
        motion: the capture.
        who: whose hands they are.
        joint_map: body joint -> rig joint, for a skeleton.
        named: a body, marker or joint that is the hand; None to find hands by their names: left,
            right, or with hand, controller, touch, wrist or wand in them.

    Raises:
        ReachingError: there is no hand, or none of this name; the message lists the names.
    """
    names, times_s, places = _places(motion)
    if isinstance(motion, RigMotion):
        mapped = dict(joint_map or {})
        hands = [mapped[joint] for joint in _JOINTS if joint in mapped]
        trunk = mapped.get("Hips")
    else:
        hands = [one for one in names if _SIDE.match(one) or _HAND.search(one)]
        trunk = next((one for one in names if _TRUNK.search(one)), None)
        if isinstance(motion, MarkerMotion):
            # Several markers are on one hand: only the person knows which of them to follow.
            hands = []
    if named is not None:
        hands = [one for one in names if one == named]
    if not hands:
        asked = "no hand" if named is None else f"nothing named {named!r}"
        raise ReachingError(
            f"{who.source}: there is {asked} among {_some(names)}. Name the hand with --hand."
        )
    base = None if trunk is None or trunk in hands else places[:, names.index(trunk)]
    found = [
        HandTrack(times_s, places[:, names.index(hand)], hand, who, base)
        for hand in dict.fromkeys(hands)
    ]
    return [track for track in found if _moves(track)]


def _places(
    motion: BodyMotion | MarkerMotion | RigMotion,
) -> tuple[Sequence[str], FloatArray, FloatArray]:
    """Return the names of M points, times (N,) and positions (N, M, 3)."""
    if isinstance(motion, BodyMotion):
        return motion.names, motion.times_s, motion.positions_m
    times_s = np.arange(motion.frame_count, dtype=np.float64) / motion.rate_hz
    if isinstance(motion, MarkerMotion):
        return motion.names, times_s, motion.positions_m
    return motion.rig.names, times_s, motion.world()[0]


def _moves(track: HandTrack) -> bool:
    seen = track.positions_m[np.isfinite(track.positions_m).all(axis=1)]
    return len(seen) > 1 and bool((np.ptp(seen, axis=0) > 0.0).any())


def _some(names: Sequence[str]) -> str:
    return ", ".join(names[:12]) + (", ..." if len(names) > 12 else "")
