"""The data types of reaching: the path of a hand, and the reaches that it is cut into.

Positions are in the world of the recording, in metres; nothing depends on its origin or its axes.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from app.science.rotations import FloatArray

Kind = Literal["human", "synthetic"]
"""Whether a person or a program moved the hand; stored with all data derived from it."""
DISTANCE, DIFFICULTY = "distance_m", "difficulty_bits"
"""Names of the dependencies: metres, and bits of the index of difficulty."""
USUAL_NEAR_M = 0.05
"""Half width of a target whose width is not known: that of a goal of the simulation."""


class ReachingError(ValueError):
    """Reaches or a reaching model are invalid; the message says what is wrong and what to do."""


@dataclass(frozen=True)
class Reacher:
    """Whose hand it is, and where its path comes from.

    Attributes:
        subject: the person; reaches of one subject are never split between training and test.
        source: origin of the data, such as a file's name.
        kind: human or synthetic.
        width_m: width of the targets of this recording, None if unknown.
    """

    subject: str
    source: str
    kind: Kind = "human"
    width_m: float | None = None

    def __post_init__(self) -> None:
        """Raise ReachingError for a width that no target has."""
        if self.width_m is not None and not 0.001 <= self.width_m <= 2.0:
            raise ReachingError(
                f"A target of {self.source} is {self.width_m} m wide: give metres, 0.001 to 2."
            )


@dataclass(frozen=True, eq=False)
class HandTrack:
    """The path of one hand over time.

    Attributes:
        times_s: (N,) increasing times.
        positions_m: (N, 3) positions, NaN where the hand was not seen.
        hand: its name in the recording.
        who: whose it is.
        trunk_m: (N, 3) the head or the hips, NaN where not seen; None if neither was recorded.
    """

    times_s: FloatArray
    positions_m: FloatArray
    hand: str
    who: Reacher
    trunk_m: FloatArray | None = None

    def __post_init__(self) -> None:
        """Raise ReachingError for shapes that do not match, or times that do not increase."""
        count = len(self.times_s)
        trunk = self.positions_m if self.trunk_m is None else self.trunk_m
        if self.positions_m.shape != (count, 3) or trunk.shape != (count, 3):
            raise ReachingError(
                f"The path of {self.name} has {count} times, positions {self.positions_m.shape} and"
                f" a trunk {trunk.shape}: give (N,), (N, 3) and (N, 3)."
            )
        if not (np.isfinite(self.times_s).all() and (np.diff(self.times_s) > 0.0).all()):
            raise ReachingError(
                f"The times of {self.name} do not increase: give seconds, in order."
            )

    @property
    def name(self) -> str:
        """The recording and the hand, for messages."""
        return f"{self.who.source}, {self.hand}"


@dataclass(frozen=True, eq=False)
class Reach:
    """One movement of a hand from rest to rest, smoothed.

    Attributes:
        times_s: (N,) increasing times from 0, the moment at which the hand exceeds the speed that
            counts as rest, to the moment at which it falls below it.
        positions_m: (N, 3) positions at these times.
        hand: its name in the recording.
        who: whose it is.
    """

    times_s: FloatArray
    positions_m: FloatArray
    hand: str
    who: Reacher

    def __post_init__(self) -> None:
        """Raise ReachingError unless there are three samples or more and the hand gets away."""
        count = len(self.times_s)
        if count < 3 or self.positions_m.shape != (count, 3) or self.times_s[0] != 0.0:
            raise ReachingError(
                f"A reach has times {self.times_s.shape} and positions {self.positions_m.shape}:"
                " give three samples or more, (N,) from 0 and (N, 3)."
            )
        if not self.distance_m > 0.0:
            raise ReachingError("A reach that ends where it begins has no distance.")

    @property
    def duration_s(self) -> float:
        """Time from the first to the last moment."""
        return float(self.times_s[-1])

    @cached_property
    def distance_m(self) -> float:
        """Amplitude: the straight distance between its ends."""
        return float(np.linalg.norm(self.positions_m[-1] - self.positions_m[0]))

    @cached_property
    def length_m(self) -> float:
        """Distance along the path of the hand."""
        return float(np.linalg.norm(np.diff(self.positions_m, axis=0), axis=1).sum())

    @property
    def straightness(self) -> float:
        """Amplitude over length: 1 for a straight path."""
        return self.distance_m / self.length_m

    @cached_property
    def peak_share(self) -> float:
        """When the hand is fastest, as a share of the duration."""
        speeds = np.linalg.norm(np.gradient(self.positions_m, self.times_s, axis=0), axis=1)
        return float(self.times_s[int(np.argmax(speeds))] / self.duration_s)

    @property
    def near_m(self) -> float:
        """Half width of the target; the usual one if it is not known."""
        return USUAL_NEAR_M if self.who.width_m is None else self.who.width_m / 2.0
