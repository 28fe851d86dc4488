"""How much somebody looked around: whether an alignment can be found from it at all.

Turning about a single axis never shows how the tracker is turned about that axis, nor where it is
along it; two axes show all (Tsai and Lenz 1989, lemma 4). So what counts is how far the head turned
about its second-best axis.
"""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from app.science.alignment.poses import mean_rotation
from app.science.rotations import FloatArray, conjugate, multiply, to_rotation_vector

ENOUGH_RAD = 0.1
"""The spread about the second axis that makes a good fit within 10 s."""
_LEAST_RAD = 0.03


@dataclass(frozen=True)
class Looking:
    """How far the head turned, as a person sees it, in the head's axes: x right, y up, z back.

    Attributes:
        turn_rad: range of turning left and right, from its 5th to its 95th percentile.
        nod_rad: the same, up and down.
        tilt_rad: the same, towards the shoulders.
        spread_rad: standard deviations of the turns about the three axes about which the head
            turned most, second most and least.
        missing: what to do besides, where the turns cannot show an alignment; None if they can.
    """

    turn_rad: float
    nod_rad: float
    tilt_rad: float
    spread_rad: tuple[float, float, float]
    missing: Literal["still", "turn", "nod"] | None

    @property
    def progress(self) -> float:
        """How much of the looking around for a good fit is done, from 0 to 1."""
        return min(1.0, self.spread_rad[1] / ENOUGH_RAD)


def looking_around(rotations: FloatArray) -> Looking:
    """Return how much a head with the rotations (N, 4), world_from_head, looked around."""
    middle = mean_rotation(rotations, np.ones(len(rotations)))
    turns = to_rotation_vector(multiply(conjugate(middle), rotations))
    low, high = np.percentile(turns, (5.0, 95.0), axis=0)
    nod, turn, tilt = (high - low).tolist()
    values, axes = np.linalg.eigh(np.cov(turns, rowvar=False))
    third, second, first = np.sqrt(np.maximum(values, 0.0)).tolist()
    missing: Literal["still", "turn", "nod"] | None = None
    if first < _LEAST_RAD:
        missing = "still"
    elif second < _LEAST_RAD:
        # Turned mostly about its upward axis: what is missing is looking up and down.
        missing = "nod" if abs(axes[1, 2]) > abs(axes[0, 2]) else "turn"
    return Looking(turn, nod, tilt, (first, second, third), missing)
