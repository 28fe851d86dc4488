"""Data types for other contents of captures: markers, and rigid bodies outside any skeleton.

The world is y up and right-handed, lengths are metres. Unobserved values are NaN.
"""

from dataclasses import dataclass

import numpy as np

from app.science.rig.model import RigError
from app.science.rotations import FloatArray


@dataclass(frozen=True, eq=False)
class MarkerMotion:
    """N frames of M named markers at a constant sampling rate.

    Attributes:
        names: labels as in the file, without a subject's prefix.
        rate_hz: frames per second.
        positions_m: (N, M, 3) positions, NaN where a marker was not observed.
    """

    names: tuple[str, ...]
    rate_hz: float
    positions_m: FloatArray

    def __post_init__(self) -> None:
        """Raise RigError if the arrays' shapes do not fit together."""
        if self.positions_m.ndim != 3 or self.positions_m.shape[1:] != (len(self.names), 3):
            raise RigError(
                f"{len(self.names)} markers need (N, {len(self.names)}, 3) positions, got"
                f" {self.positions_m.shape}."
            )

    @property
    def frame_count(self) -> int:
        """Return the number of frames N."""
        return int(self.positions_m.shape[0])


@dataclass(frozen=True, eq=False)
class BodyMotion:
    """N samples of B rigid bodies, each with a position and a rotation in the world.

    Attributes:
        names: the names of the bodies.
        times_s: (N,) since the first sample; loggers seldom keep a constant sampling rate.
        positions_m: (N, B, 3) positions, NaN where a body was not observed.
        rotations: (N, B, 4) world_from_body, NaN where a body was not observed.
    """

    names: tuple[str, ...]
    times_s: FloatArray
    positions_m: FloatArray
    rotations: FloatArray

    def __post_init__(self) -> None:
        """Raise RigError if the arrays' shapes do not fit together."""
        shape = (len(self.times_s), len(self.names))
        if self.positions_m.shape != (*shape, 3) or self.rotations.shape != (*shape, 4):
            raise RigError(
                f"{shape[0]} times and {shape[1]} bodies do not fit positions"
                f" {self.positions_m.shape} and rotations {self.rotations.shape}."
            )

    @property
    def frame_count(self) -> int:
        """Return the number of samples N."""
        return len(self.times_s)

    @property
    def rate_hz(self) -> float:
        """Return the samples per second by the median time step; 0 for fewer than two samples."""
        if self.frame_count < 2:
            return 0.0
        return float(1.0 / np.median(np.diff(self.times_s)))
