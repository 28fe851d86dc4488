"""Define how far each axis of a human body turns.

Angles are counted from the T-pose and positive in the direction that `parts` names. Two presets:
`anatomic`, and `free`, in which the elbow's third axis, which no human elbow has, turns a full
circle as in the thesis (Karas 2020, section 3.2.2).

Each row names its source. A range that sources give for a chain of joints (trunk, neck) is divided
equally among the joints of the chain: an estimate, as is every row whose source says so.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi, radians
from types import MappingProxyType
from typing import Literal

from app.science.avatar.body import AXES, FINGERS

Preset = Literal["anatomic", "free"]

AAOS = "AAOS handbook, in Norkin and White, Measurement of Joint Motion, table A.1"
BOONE = "Boone and Azen 1979, in Norkin and White, Measurement of Joint Motion, table A.1"
MERCK = "Merck Manual, normal values for range of motion of joints, table 1"
NECK = "ISRN Rehabilitation 2012, 751768, table 8"
KURZ = "Kurz, Stretching Scientifically, normal ranges of joint motion"
APPENDIX = "AccessPhysiotherapy, book 3363, appendix 1, range of motion for diarthrodial joints"
ZARINS = "Zarins et al. 1983, Am. J. Sports Med. 11(3), 152-156"
HAND = "Electronic Textbook of Hand Surgery, normal range of motion reference values"
ESTIMATE = "estimate"


@dataclass(frozen=True)
class AxisLimits:
    """Lower and upper limit of one axis.

    Attributes:
        low_rad, high_rad: both zero where the axis is locked.
        source: publication of the numbers; starts with `ESTIMATE` where one of them is ours.
    """

    low_rad: float
    high_rad: float
    source: str

    @property
    def estimated(self) -> bool:
        """Return whether at least one of the two numbers is our estimate."""
        return self.source.startswith(ESTIMATE)


_Row = tuple[float, float, str]
_SHARED = f"{ESTIMATE}: equal shares of"
_SPINE: Mapping[str, _Row] = {
    "X": (-10.0, 25.0, f"{_SHARED} 30 back and 75 forward, {KURZ}"),
    "Z": (-35.0 / 3.0, 35.0 / 3.0, f"{_SHARED} 35 to each side, {KURZ}"),
    "Y": (-15.0, 15.0, f"{_SHARED} 45 to each side for the whole trunk"),
}
_CERVICAL: Mapping[str, _Row] = {
    "X": (-22.5, 22.5, f"{_SHARED} 45 back and forward, {NECK}"),
    "Z": (-22.5, 22.5, f"{_SHARED} 45 to each side, {NECK}"),
    "Y": (-35.0, 35.0, f"{_SHARED} 70 to each side, {KURZ}"),
}
# In degrees. The T-pose is the zero of the arm's rotation as AAOS measures it: raised to the side,
# the bent forearm pointing forward; and the zero of the forearm's, as the palm then faces down.
_ROWS: Mapping[str, Mapping[str, _Row]] = {
    **dict.fromkeys(("Spine", "Chest", "UpperChest"), _SPINE),
    **dict.fromkeys(("Neck", "Head"), _CERVICAL),
    "UpperArm": {
        "Y": (-45.0, 135.0, f"horizontal abduction and adduction: {APPENDIX}"),
        "Z": (-120.0, 90.0, f"{ESTIMATE} below: hanging and 30 across the body; abduction: {AAOS}"),
        "X": (-104.0, 70.0, f"lateral rotation: {BOONE}; medial: {AAOS}"),
    },
    "LowerArm": {
        "Y": (0.0, 150.0, f"flexion: {AAOS}"),
        "Z": (0.0, 0.0, "no such movement in a human elbow"),
        "X": (-80.0, 80.0, f"supination and pronation: {AAOS}"),
    },
    "Hand": {
        "Z": (-70.0, 80.0, f"extension and flexion: {AAOS}"),
        "Y": (-30.0, 20.0, f"ulnar and radial deviation: {AAOS}"),
        "X": (-10.0, 10.0, f"{ESTIMATE}: the little that a wrist gives way"),
    },
    "UpperLeg": {
        "X": (-15.0, 125.0, f"hyperextension and flexion: {MERCK}"),
        "Z": (-30.0, 45.0, f"adduction: {KURZ}; abduction: {MERCK}"),
        "Y": (-45.0, 45.0, f"rotation: {MERCK}"),
    },
    "LowerLeg": {
        "X": (0.0, 130.0, f"flexion: {MERCK}"),
        "Y": (-45.0, 25.0, f"external and internal rotation of the bent knee: {ZARINS}"),
    },
    "Foot": {
        "X": (-50.0, 20.0, f"plantar flexion and dorsiflexion: {MERCK}"),
        "Z": (-25.0, 35.0, f"eversion and inversion: {MERCK}"),
        "Y": (-20.0, 20.0, f"{ESTIMATE}: abduction and adduction of the forefoot"),
    },
    "Toes": {"X": (-30.0, 80.0, f"flexion and extension of the metatarsophalangeals: {MERCK}")},
    # In the T-pose the thumb points 45 degrees away from the index finger.
    "ThumbProximal": {
        "Y": (-15.0, 60.0, f"{ESTIMATE}: 60 from the index finger, {HAND}; 15 across, {APPENDIX}"),
        "Z": (-15.0, 45.0, f"{ESTIMATE} upwards; palmar abduction: {HAND}"),
    },
    "ThumbIntermediate": {"Y": (-10.0, 55.0, f"hyperextension and flexion: {HAND}")},
    "ThumbDistal": {"Y": (-15.0, 80.0, f"hyperextension and flexion: {HAND}")},
    **{
        f"{finger}{segment}": rows
        for finger in FINGERS[1:]
        for segment, rows in {
            "Proximal": {
                "Z": (-45.0, 90.0, f"hyperextension and flexion: {HAND}"),
                "Y": (-20.0, 20.0, f"adduction, the lesser of the two ways: {MERCK}"),
            },
            "Intermediate": {"Z": (0.0, 100.0, f"flexion: {HAND}")},
            "Distal": {"Z": (0.0, 80.0, f"flexion: {HAND}")},
        }.items()
    },
}
_FREE_ELBOW = AxisLimits(-pi, pi, "free as in Karas 2020, section 3.2.2")


def _limits(part: str, letter: str) -> AxisLimits:
    low, high, source = _ROWS[part.removeprefix("Left").removeprefix("Right")][letter]
    return AxisLimits(radians(low), radians(high), source)


ANATOMIC: Mapping[str, AxisLimits] = MappingProxyType(
    {axis.name: _limits(axis.part, axis.letter) for axis in AXES}
)
"""Limits of a human body, by the names of the axes."""
FREE: Mapping[str, AxisLimits] = MappingProxyType(
    {**ANATOMIC, "LeftLowerArmZ": _FREE_ELBOW, "RightLowerArmZ": _FREE_ELBOW}
)
"""Limits of a human body, but with the elbow's third axis free."""


def limits_of(preset: Preset) -> Mapping[str, AxisLimits]:
    """Return the limits of every axis in a preset, by axis name."""
    return FREE if preset == "free" else ANATOMIC
