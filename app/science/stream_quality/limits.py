"""What counts as a fault of a stream of poses. Every limit can be set; these are the usual ones."""

import math
from dataclasses import dataclass

from app.science.skeleton import JOINT_INDEX

TOES = (JOINT_INDEX["LeftToes"], JOINT_INDEX["RightToes"])


class QualityError(ValueError):
    """The arrays do not belong together; says which shapes they have and should have."""


@dataclass(frozen=True)
class QualityLimits:
    """From where on something is a fault.

    Gap: no frame for longer than `gap_frames` usual intervals and longer than `gap_s`: two frames
    that come late are no gap at any display rate.

    Jump: a joint turns faster than `turn_rad_per_s`, or the hips move faster than `root_m_per_s`.
    Elbows and wrists of people who hurry reach 1300 deg/s; a sprinter runs 12 m/s, a participant in
    a laboratory does not.

    Frozen: a rotation that stays the same to the last bit for `frozen_s` while at least `others`
    joints move, though the joint was lively before: for `known_s` at least, and for `lively_share`
    of the time, it had changed within `lively_s`. Tracking is never that still. Joints that nobody
    tracks, or that a solver lets rest now and then, have not been lively. `may_rest` joints rest on
    the floor with the foot they belong to and are left out.

    Rotation: a quaternion whose length is off 1 by more than `unit_tolerance` is none. Time: what
    lies further from zero than `latest_s`, thirty years, is no reading of a clock, and stands for
    nothing.
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
    latest_s: float = 1e9


USUAL = QualityLimits()
