"""The landmarks of a body over time, with short gaps bridged."""

from dataclasses import dataclass

import numpy as np

from app.science.fitting.marker_sets import MARKER_SETS, MarkerSet
from app.science.fitting.resampling import bridged
from app.science.rig import BoolArray, MarkerMotion
from app.science.rotations import FloatArray

# Inner markers are often worn in the standing trial only: use one if it is nearly always present.
_MOSTLY = 0.9


@dataclass(frozen=True, eq=False)
class Landmarks:
    """Positions (N, 3) of landmarks and whether they were seen (N,); see `marker_sets`.

    Attributes:
        set: the marker set by which they were identified.
        markers: landmark -> name of its marker.
        places, seen: positions and visibility, by landmark.
        names: the names of all markers of the capture.
        frames: the number of frames, N.
    """

    set: MarkerSet
    markers: dict[str, str]
    places: dict[str, FloatArray]
    seen: dict[str, BoolArray]
    names: tuple[str, ...]
    frames: int

    def has(self, *names: str) -> bool:
        """Return whether all these landmarks have a marker."""
        return all(name in self.places for name in names)

    def nearly_always_with(self, inner: str, outer: str) -> bool:
        """Return whether the inner marker is present nearly whenever the outer one is."""
        if not self.has(inner, outer):
            return False
        there = np.isfinite(self.places[outer]).all(axis=-1)
        both = there & np.isfinite(self.places[inner]).all(axis=-1)
        return bool(both.sum() >= _MOSTLY * there.sum())

    def __getitem__(self, name: str) -> FloatArray:
        return self.places[name]

    def middle(self, *names: str) -> FloatArray:
        """Return the mean position of several landmarks."""
        middle: FloatArray = np.mean([self.places[name] for name in names], axis=0)
        return middle

    def all_seen(self, *names: str) -> BoolArray:
        """Return in which frames (N,) all of these landmarks were seen, not bridged.

        Landmarks without a marker are ignored.
        """
        seen: BoolArray = np.ones(self.frames, np.bool_)
        for name in names:
            seen = seen & self.seen.get(name, seen)
        return seen


def landmarks_of(motion: MarkerMotion) -> Landmarks:
    """Return the landmarks by the marker set that recognises most of these markers."""
    found = [(marker_set, marker_set.found_in(motion.names)) for marker_set in MARKER_SETS]
    best, markers = max(found, key=lambda pair: len(pair[1]))
    places: dict[str, FloatArray] = {}
    seen: dict[str, BoolArray] = {}
    for landmark, marker in markers.items():
        place, was_seen = bridged(motion.positions_m[:, motion.names.index(marker)], motion.rate_hz)
        if was_seen.any():
            places[landmark], seen[landmark] = place, was_seen
    return Landmarks(best, markers, places, seen, motion.names, motion.frame_count)
