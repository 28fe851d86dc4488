"""What a skeleton does while it was not seen: it goes on between the frames around the gap."""

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray, slerp

BoolArray = npt.NDArray[np.bool_]


def unseen(*values: FloatArray) -> BoolArray:
    """Where any number of a body's, in any of the arrays (..., C), is missing: shape (...)."""
    missing = [np.isnan(array).any(axis=-1) for array in values]
    return np.asarray(np.logical_or.reduce(missing), dtype=np.bool_)


def fill_places(places: FloatArray, seen: BoolArray) -> FloatArray:
    """Carry places (N, 3) over gaps in a straight line; before and after, the nearest holds."""
    if seen.all():
        return places
    known, frames = np.flatnonzero(seen), np.arange(len(seen))
    return np.stack(
        [np.interp(frames, known, places[known, axis]) for axis in range(places.shape[1])], axis=-1
    )


def fill_rotations(rotations: FloatArray, seen: BoolArray) -> FloatArray:
    """Carry rotations (N, 4) over gaps by the shorter turn at constant speed."""
    if seen.all():
        return rotations
    known, missing = np.flatnonzero(seen), np.flatnonzero(~seen)
    after = np.searchsorted(known, missing)
    before = known[np.clip(after - 1, 0, len(known) - 1)]
    behind = known[np.clip(after, 0, len(known) - 1)]
    span = np.maximum(behind - before, 1)
    fraction = np.clip((missing - before) / span, 0.0, 1.0)
    filled = rotations.copy()
    filled[missing] = slerp(rotations[before], rotations[behind], fraction)
    return filled
