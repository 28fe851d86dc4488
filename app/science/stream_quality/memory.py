"""What the next span of frames must know of those before it."""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.science.skeleton import JOINT_COUNT


@dataclass(frozen=True)
class LastPose:
    """The newest usable frame: its time and place on the watched time (s), rotations (22, 4) and
    place of the hips (3,) in m.
    """

    time_s: float
    watched_s: float
    rotations: NDArray[np.floating[Any]]
    position_m: NDArray[np.floating[Any]]


def _zeros() -> NDArray[np.float64]:
    return np.zeros(JOINT_COUNT)


@dataclass(frozen=True)
class Memory:
    """Carried from span to span, so that it does not matter where a recording is cut.

    `time_s` is the time of the newest frame. `watched_s` counts time for which there were frames,
    gaps left out; on it lies `changed_s` (22,), when each joint last changed. `lively_s` and
    `frozen_s` (22,) are for how long each joint was lively and frozen so far; `frozen` (22,) says
    which were frozen last.
    """

    time_s: float | None = None
    pose: LastPose | None = None
    watched_s: float = 0.0
    changed_s: NDArray[np.float64] = field(default_factory=_zeros)
    lively_s: NDArray[np.float64] = field(default_factory=_zeros)
    frozen_s: NDArray[np.float64] = field(default_factory=_zeros)
    frozen: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(JOINT_COUNT, np.bool_))

    @property
    def still_s(self) -> NDArray[np.float64]:
        """For how long each joint has been the same to the bit, (22,) in s."""
        return self.watched_s - self.changed_s

    def without_pose(self) -> "Memory":
        """For a span that begins with a pose of its own, which is then no jump."""
        return replace(self, pose=None)
