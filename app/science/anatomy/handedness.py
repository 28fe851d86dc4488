"""Find captures whose left and right are mirrored, as from left-handed axes, and mirror them back.

The labels say which side is left, and so, with the body's up, where its front would be:

    front = up x right,   right = from left to right hip (or shoulder),   up = from knees to hips
                          (or from hips to neck).

Joints say where it is: knees bend forwards and toes point there, and elbows bend backwards. Each of
these is a vote in every frame in which it can be seen (a joint that is nearly straight has none).
Where the labels' front is the body's back by all votes, the capture is mirrored. On the shared
captures knees agree with the labels in 97 to 100 % of their votes, toes in 88 to 100 %, elbows in
78 to 100 %; in their mirror images in what that leaves. The mirror image of a person and a person
whose labels are all swapped cannot be told apart; left-handed axes are far more frequent.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from app.science.rig import BodyMotion, MarkerMotion, RigMotion
from app.science.rotations import FloatArray

_FEWEST_VOTES = 20
_MIRRORED_SHARE = 0.2
_BENT_SINE = 0.2
"""Sine of the least bend of a knee or an elbow that votes, 12 degrees."""
_MIRROR, _MIRROR_ROTATION = np.array((-1.0, 1.0, 1.0)), np.array((1.0, 1.0, -1.0, -1.0))


@dataclass(frozen=True)
class Handedness:
    """The share of frames in which each kind of vote agrees with the labels of left and right.

    `agreeing` has `knees`, `toes` and `elbows`, as far as there are enough votes.
    """

    agreeing: Mapping[str, float]

    @property
    def is_mirrored(self) -> bool:
        """Whether the votes find front and back swapped.

        Legs decide where there are any; arms move too freely to overrule them.
        """
        legs = [self.agreeing[kind] for kind in ("knees", "toes") if kind in self.agreeing]
        shares = legs or list(self.agreeing.values())
        return bool(shares) and max(shares) < _MIRRORED_SHARE


def handedness_of(places_m: Mapping[str, FloatArray]) -> Handedness:
    """Return the votes on left and right.

    Args:
        places_m: body joint -> positions (N, 3) in the world, NaN where unknown. Joints that are
            not captured are left out.
    """
    votes = _leg_votes(places_m) | _arm_votes(places_m)
    agreeing = {}
    for kind, per_side in votes.items():
        cast = np.concatenate([*per_side, np.empty(0)])
        cast = cast[np.isfinite(cast) & (cast != 0.0)]
        if len(cast) >= _FEWEST_VOTES:
            agreeing[kind] = float(np.mean(cast > 0.0))
    return Handedness(agreeing)


def knees_agreeing(places_m: Mapping[str, FloatArray]) -> dict[str, float]:
    """Return the share of frames in which each knee bends forwards, by side, `left` and `right`.

    Args:
        places_m: as for `handedness_of`. Knees with too few votes are left out.
    """
    votes = _leg_votes(places_m).get("knees", [])
    cast = {
        side.lower(): own[np.isfinite(own) & (own != 0.0)]
        for side, own in zip(_sides(places_m), votes, strict=bool(votes))
    }
    return {
        side: float(np.mean(own > 0)) for side, own in cast.items() if len(own) >= _FEWEST_VOTES
    }


def _sides(places_m: Mapping[str, FloatArray]) -> list[str]:
    return [side for side in ("Left", "Right") if f"{side}Foot" in places_m]


def _leg_votes(places_m: Mapping[str, FloatArray]) -> dict[str, list[FloatArray]]:
    sides = _sides(places_m)
    if not sides or not _has(places_m, "UpperLeg", "LowerLeg"):
        return {}
    up = _middle(places_m, "UpperLeg") - _middle(places_m, "LowerLeg")
    front = np.cross(up, places_m["RightUpperLeg"] - places_m["LeftUpperLeg"])
    legs = [
        [places_m[f"{side}{part}"] for part in ("UpperLeg", "LowerLeg", "Foot")] for side in sides
    ]
    return {
        "knees": [_bend(hip, knee, ankle, front) for hip, knee, ankle in legs],
        "toes": [
            _along(places_m[f"{side}Toes"] - places_m[f"{side}Foot"], front)
            for side in sides
            if f"{side}Toes" in places_m
        ],
    }


def _arm_votes(places_m: Mapping[str, FloatArray]) -> dict[str, list[FloatArray]]:
    if not _has(places_m, "UpperArm") or not {"Neck", "Hips"} <= set(places_m):
        return {}
    up = places_m["Neck"] - places_m["Hips"]
    front = np.cross(up, places_m["RightUpperArm"] - places_m["LeftUpperArm"])
    arms = [
        [places_m[f"{side}{part}"] for part in ("UpperArm", "LowerArm", "Hand")]
        for side in ("Left", "Right")
        if {f"{side}LowerArm", f"{side}Hand"} <= set(places_m)
    ]
    return {"elbows": [-_bend(shoulder, elbow, hand, front) for shoulder, elbow, hand in arms]}


def _has(places_m: Mapping[str, FloatArray], *parts: str) -> bool:
    """Return whether both sides of these body parts are known."""
    return all(f"{side}{part}" in places_m for side in ("Left", "Right") for part in parts)


def mirrored_markers(motion: MarkerMotion) -> MarkerMotion:
    """Return the mirror image of markers: x negated, so left-handed axes become right-handed."""
    return replace(motion, positions_m=motion.positions_m * _MIRROR)


def mirrored_bodies(motion: BodyMotion) -> BodyMotion:
    """Return the mirror image of rigid bodies; see `mirrored_markers`."""
    positions, rotations = motion.positions_m * _MIRROR, motion.rotations * _MIRROR_ROTATION
    return replace(motion, positions_m=positions, rotations=rotations)


def mirrored_skeleton(motion: RigMotion) -> RigMotion:
    """Return the mirror image of a skeleton's movement; see `mirrored_markers`."""
    rig = replace(
        motion.rig,
        offsets_m=motion.rig.offsets_m * _MIRROR,
        rest_rotations=motion.rig.rest_rotations * _MIRROR_ROTATION,
        ends=tuple((joint, (-x, y, z)) for joint, (x, y, z) in motion.rig.ends),
    )
    return replace(
        motion,
        rig=rig,
        root_positions_m=motion.root_positions_m * _MIRROR,
        rotations=motion.rotations * _MIRROR_ROTATION,
    )


def _middle(places_m: Mapping[str, FloatArray], part: str) -> FloatArray:
    return np.asarray(0.5 * (places_m[f"Left{part}"] + places_m[f"Right{part}"]))


def _along(vectors: FloatArray, front: FloatArray) -> FloatArray:
    """Return the sign of each vector's part along the front; 0 where it is nearly across."""
    product = np.einsum("ni,ni->n", vectors, front)
    sizes = np.linalg.norm(vectors, axis=1) * np.linalg.norm(front, axis=1)
    return np.asarray(np.where(np.abs(product) > _BENT_SINE * sizes, np.sign(product), 0.0))


def _bend(start: FloatArray, joint: FloatArray, end: FloatArray, front: FloatArray) -> FloatArray:
    """Return on which side of the line from start to end a bent joint lies: 1 front, -1 back.

    0 where it is nearly straight.
    """
    line = end - start
    length = np.maximum(np.linalg.norm(line, axis=1, keepdims=True), 1e-9)
    line = line / length
    off = (joint - start) - np.einsum("ni,ni->n", joint - start, line)[:, np.newaxis] * line
    bent = np.linalg.norm(off, axis=1) > 0.5 * _BENT_SINE * np.linalg.norm(joint - start, axis=1)
    return np.asarray(np.where(bent, _along(off, front), 0.0))
