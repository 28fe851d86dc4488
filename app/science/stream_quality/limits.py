"""Limits beyond which something counts as a fault in a stream of poses, with their defaults."""

import math
from dataclasses import dataclass

from app.science.skeleton import JOINT_INDEX

TOES = (JOINT_INDEX["LeftToes"], JOINT_INDEX["RightToes"])


class QualityError(ValueError):
    """The shapes of the arrays do not match; the message names the actual and the required ones."""


@dataclass(frozen=True)
class QualityLimits:
    """Limits beyond which something counts as a fault of a stream.

    Gap: no frame for longer than `gap_frames` typical intervals and longer than `gap_s`; two late
    frames are therefore not a gap at any display rate.

    Jump: a joint turns faster than `turn_rad_per_s`, or the hips move faster than `root_m_per_s`.
    Elbows and wrists of people who hurry reach 1300 deg/s; a sprinter runs at 12 m/s, a participant
    in a laboratory does not.

    Frozen: a rotation stays the same to the last bit for `frozen_s` while at least `others` joints
    move, although the joint was lively before: for at least `known_s`, and for `lively_share` of
    the time, it had changed within the preceding `lively_s`. Tracking is never that still. Joints
    that are not tracked, or that a solver keeps at rest now and then, have not been lively. The
    `may_rest` joints rest on the floor with the foot they belong to and are exempt.

    Rotation: a quaternion whose length deviates from 1 by more than `unit_tolerance` is invalid.
    Position: hips more than `farthest_m` along an axis from the origin are in no room: invalid.
    Time: a value further from zero than `latest_s`, thirty years, is not a clock reading and is
    ignored.
    """

    gap_frames: float = 2.5
    gap_s: float = 0.040
    turn_rad_per_s: float = math.radians(2000.0)
    root_m_per_s: float = 10.0
    frozen_s: float = 1.0
    others: int = 3
    lively_s: float = 0.2
    lively_share: float = 0.9
    known_s: float = 2.0
    may_rest: tuple[int, ...] = TOES
    unit_tolerance: float = 1e-3
    farthest_m: float = 1000.0
    latest_s: float = 1e9


DEFAULT_LIMITS = QualityLimits()
