"""The landmarks of a body over time, short gaps bridged."""

from dataclasses import dataclass

import numpy as np

from app.science.fitting.marker_sets import MARKER_SETS, MarkerSet
from app.science.fitting.resampling import bridged
from app.science.rig import BoolArray, MarkerMotion
from app.science.rotations import FloatArray

# An inner marker often stands only in the standing trial: use it where it nearly always is there.
_MOSTLY = 0.9


@dataclass(frozen=True, eq=False)
class Landmarks:
    """Places (N, 3) and whether they were seen (N,), by landmark; see `marker_sets`.

    Attributes:
        set: the marker set they were read by.
        markers: landmark -> the marker it was.
        names: all markers of the capture.
        frames: N.
    """

    set: MarkerSet
    markers: dict[str, str]
    places: dict[str, FloatArray]
    seen: dict[str, BoolArray]
    names: tuple[str, ...]
    frames: int

    def has(self, *names: str) -> bool:
        """Whether all these landmarks are marked."""
        return all(name in self.places for name in names)

    def keeps_up_with(self, inner: str, outer: str) -> bool:
        """Whether the inner marker is there nearly whenever the outer one is."""
        if not self.has(inner, outer):
            return False
        there = np.isfinite(self.places[outer]).all(axis=-1)
        both = there & np.isfinite(self.places[inner]).all(axis=-1)
        return bool(both.sum() >= _MOSTLY * there.sum())

    def __getitem__(self, name: str) -> FloatArray:
        return self.places[name]

    def middle(self, *names: str) -> FloatArray:
        """The mean of several landmarks."""
        middle: FloatArray = np.mean([self.places[name] for name in names], axis=0)
        return middle

    def all_seen(self, *names: str) -> BoolArray:
        """(N,) whether all of these that are marked were seen, not bridged."""
        seen: BoolArray = np.ones(self.frames, np.bool_)
        for name in names:
            seen = seen & self.seen.get(name, seen)
        return seen


def landmarks_of(motion: MarkerMotion) -> Landmarks:
    """Find the landmarks in the marker set that knows most of these markers."""
    found = [(known, known.found_in(motion.names)) for known in MARKER_SETS]
    best, markers = max(found, key=lambda pair: len(pair[1]))
    places: dict[str, FloatArray] = {}
    seen: dict[str, BoolArray] = {}
    for landmark, marker in markers.items():
        place, was_seen = bridged(motion.positions_m[:, motion.names.index(marker)], motion.rate_hz)
        if was_seen.any():
            places[landmark], seen[landmark] = place, was_seen
    return Landmarks(best, markers, places, seen, motion.names, motion.frame_count)
