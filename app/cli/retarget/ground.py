"""The ground an avatar is led over, as one word on the command line.

    flat               level, which is usual
    kerb:H@D           a step of H metres after D metres of the way
    ramp:H/L@D         H metres up over L metres, beginning after D metres of the way

Heights below zero go down. The way is the straight line from where the avatar's hips begin to where
they end.
"""

import math
import re
from collections.abc import Callable

from app.science.retargeting import Ground, Ramp, Steps
from app.science.rotations import FloatArray

_NUMBER = r"([+-]?\d{1,3}(?:\.\d{1,4})?)"
_KERB = re.compile(rf"kerb:{_NUMBER}@{_NUMBER}")
_RAMP = re.compile(rf"ramp:{_NUMBER}/{_NUMBER}@{_NUMBER}")
_VALID = "flat, kerb:HEIGHT@DISTANCE and ramp:HEIGHT/LENGTH@DISTANCE are valid, all in metres"
GroundAlong = Callable[[FloatArray], Ground]


def ground_along(told: str) -> GroundAlong | None:
    """What makes the ground a word names, once the way of the hips (N, 3) is known; None for flat.

    Raises:
        ValueError: the word names no ground. What is returned raises it too, where hips that go
            nowhere give the ground no direction.
    """
    if told == "flat":
        return None
    kerb, ramp = _KERB.fullmatch(told), _RAMP.fullmatch(told)
    if kerb is not None:
        height, distance = (float(number) for number in kerb.groups())
        return lambda hips_m: Steps(*_way(told, hips_m), (distance,), (height,))
    if ramp is not None and float(ramp[2]) > 0.0:
        return lambda hips_m: _ramp(told, hips_m, *(float(number) for number in ramp.groups()))
    raise ValueError(f"--ground {told!r}: {_VALID}, such as kerb:0.12@1.5")


def _ramp(told: str, hips_m: FloatArray, height: float, length: float, distance: float) -> Ramp:
    (x, z), (along_x, along_z) = _way(told, hips_m)
    foot = (x + distance * along_x, z + distance * along_z)
    return Ramp(foot, (along_x, along_z), run_m=length, rise_m=height)


def _way(told: str, hips_m: FloatArray) -> tuple[tuple[float, float], tuple[float, float]]:
    """Where the hips begin, (x, z), and the unit direction to where they end."""
    x, _, z = (hips_m[-1] - hips_m[0]).tolist()
    length = math.hypot(x, z)
    if length < 1e-3:
        raise ValueError(f"--ground {told}: this clip goes nowhere, so only flat is possible")
    return (float(hips_m[0, 0]), float(hips_m[0, 2])), (x / length, z / length)
