"""State that the examination of a stream carries from one span of frames to the next."""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.science.skeleton import JOINT_COUNT


@dataclass(frozen=True)
class LastPose:
    """The newest valid frame of a stream.

    Its time, its watched time (both s), rotations (22, 4) and the position of the hips (3,) in m.
    """

    time_s: float
    watched_s: float
    rotations: NDArray[np.floating[Any]]
    position_m: NDArray[np.floating[Any]]


def _zeros() -> NDArray[np.float64]:
    return np.zeros(JOINT_COUNT)


@dataclass(frozen=True)
class Memory:
    """State carried from span to span, so that it does not matter where a recording is cut.

    `time_s` is the time of the newest frame. `watched_s` counts the time covered by frames, gaps
    left out; `changed_s` (22,) is the watched time at which each joint last changed. `lively_s` and
    `frozen_s` (22,) are how long each joint has been lively and frozen so far; `frozen` (22,) marks
    the joints that were frozen in the last frame.
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
        """Time for which each joint has stayed the same to the last bit, (22,) in s."""
        return self.watched_s - self.changed_s

    def without_pose(self) -> "Memory":
        """Return this memory without the last pose, so that the next pose cannot be a jump."""
        return replace(self, pose=None)
