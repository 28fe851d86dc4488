"""Compare the lengths of a body's segments with the proportions of people, and with each other.

Published lengths as fractions of the stature: thigh .245, shank .246, upper arm .186, forearm .146,
between the shoulders .258, from the hip joints up to the shoulder joints .288 (Drillis and Contini
1966, as drawn in Winter 2009, "Biomechanics and Motor Control of Human Movement", figure 4.1).
People differ: a segment between 0.7 and 1.3 times its published share is accepted, and sides that
differ by less than 3 cm or 15 %.

The stature is not captured. It follows from thigh and shank, the longest and best marked segments,
if both legs agree within a tenth; else it is the median of what all segments suggest.
"""

from collections.abc import Mapping
from statistics import median

import numpy as np

from app.science.anatomy.notice import Notice, Rule
from app.science.rotations import FloatArray

PUBLISHED: Mapping[str, float] = {
    "thigh": 0.245, "shank": 0.246, "upper arm": 0.186, "forearm": 0.146,
    "shoulders": 0.258, "trunk": 0.288,
}  # fmt: skip
"""Length of each segment in statures."""
PAIRED: Mapping[str, tuple[str, str]] = {
    "thigh": ("UpperLeg", "LowerLeg"), "shank": ("LowerLeg", "Foot"),
    "upper arm": ("UpperArm", "LowerArm"), "forearm": ("LowerArm", "Hand"),
}  # fmt: skip
"""The two joints between which a segment of each side is measured."""
LOWEST, HIGHEST = 0.7, 1.3
_LEGS_AGREE = 0.1
_SIDES_AGREE, _SIDES_AGREE_M = 0.15, 0.03


def segment_lengths(places_m: Mapping[str, FloatArray]) -> dict[str, float]:
    """Return the lengths of the segments whose joints are known: `left thigh`, `shoulders` ...

    Args:
        places_m: body joint (`LeftUpperLeg` ...) -> position (3,), all in one pose.
    """
    found: dict[str, float] = {}
    for segment, (upper, lower) in PAIRED.items():
        for side in ("Left", "Right"):
            ends = (f"{side}{upper}", f"{side}{lower}")
            if all(end in places_m for end in ends):
                found[f"{side.lower()} {segment}"] = _apart(places_m, *ends)
    arms, legs = (("LeftUpperArm", "RightUpperArm"), ("LeftUpperLeg", "RightUpperLeg"))
    if all(joint in places_m for joint in arms):
        found["shoulders"] = _apart(places_m, *arms)
        if all(joint in places_m for joint in legs):
            top, bottom = (0.5 * (places_m[a] + places_m[b]) for a, b in (arms, legs))
            found["trunk"] = float(np.linalg.norm(top - bottom))
    return found


def stature_from(lengths_m: Mapping[str, float]) -> float | None:
    """Return the stature that the lengths suggest; None without any."""
    legs = [
        lengths_m[f"{side} thigh"] + lengths_m[f"{side} shank"]
        for side in ("left", "right")
        if f"{side} thigh" in lengths_m and f"{side} shank" in lengths_m
    ]
    share = PUBLISHED["thigh"] + PUBLISHED["shank"]
    if len(legs) == 2 and abs(legs[0] - legs[1]) <= _LEGS_AGREE * max(legs):
        return sum(legs) / 2.0 / share
    suggested = [length / PUBLISHED[_kind(name)] for name, length in lengths_m.items()]
    return median(suggested) if suggested else None


def plausible_m(segment: str, stature_m: float) -> tuple[float, float]:
    """Return the shortest and longest accepted length of a segment such as `left thigh`."""
    expected = PUBLISHED[_kind(segment)] * stature_m
    return LOWEST * expected, HIGHEST * expected


def sides_agree(left_m: float, right_m: float) -> bool:
    """Return whether two sides of a body differ no more than people's do."""
    return abs(left_m - right_m) <= most_apart_m(left_m, right_m)


def most_apart_m(left_m: float, right_m: float) -> float:
    """Return by how much two sides of these lengths may differ."""
    return max(_SIDES_AGREE_M, _SIDES_AGREE * (left_m + right_m) / 2.0)


def length_notices(lengths_m: Mapping[str, float]) -> tuple[Notice, ...]:
    """Return notices on segments that do not fit the others, which are left as they are."""
    stature = stature_from(lengths_m)
    if stature is None:
        return ()
    found: list[Notice] = []
    for segment in PAIRED:
        left, right = (lengths_m.get(f"{side} {segment}") for side in ("left", "right"))
        if left is not None and right is not None and not sides_agree(left, right):
            found.append(
                _noted(
                    "sides",
                    f"The {segment}s of the skeleton differ.",
                    f"{segment} {_cm(left)} left, {_cm(right)} right",
                    f"at most {_cm(most_apart_m(left, right))} apart",
                )
            )
    for segment in PUBLISHED:
        low, high = plausible_m(segment, stature)
        measured = {name: m for name, m in lengths_m.items() if _kind(name) == segment}
        if any(not low <= length <= high for length in measured.values()):
            told = ", ".join(f"{name} {_cm(length)}" for name, length in measured.items())
            found.append(
                _noted(
                    "length",
                    f"A length of the skeleton ({segment}) does not fit a stature of"
                    f" {stature:.2f} m.",
                    told,
                    f"{_cm(low)} to {_cm(high)}",
                )
            )
    return tuple(found)


def _noted(rule: Rule, what: str, value: str, valid: str) -> Notice:
    remedy = "Joint angles are transferred as captured, and reaches differ: check the skeleton."
    return Notice(rule, "noted", what, value, valid, remedy)


def _kind(name: str) -> str:
    return name.removeprefix("left ").removeprefix("right ")


def _apart(places_m: Mapping[str, FloatArray], a: str, b: str) -> float:
    return float(np.linalg.norm(places_m[a] - places_m[b]))


def _cm(metres: float) -> str:
    return f"{100.0 * metres:.1f} cm"
