"""Determine the upward axis of marker files: declared, chosen, or guessed from the body."""

from typing import Literal

import numpy as np

from app.adapters.captures.axes import Up, turned_places
from app.adapters.captures.capture import CaptureError, Convention
from app.science.rotations import FloatArray

_AXES: tuple[Up, Up, Up] = ("x", "y", "z")
_LOOKED_AT = 200
"""Number of frames used to guess the axis."""
_CLEARLY_TALLER = 1.2
# Half a turn about x: down becomes up, and left and right hands keep their sides.
_OVER: FloatArray = np.array((1.0, -1.0, -1.0))
_FARTHEST_M = 1e5


def upright(
    positions_m: FloatArray, *, declared: str | None, chosen: Up | None, usual: Up
) -> tuple[FloatArray, Convention, tuple[str, ...]]:
    """Rotate markers (N, M, 3) so that y is up; return them, the convention and notes.

    Args:
        positions_m: NaN where a marker was not visible.
        declared: the file's name of its upward axis, such as "+Z"; None if it has none.
        chosen: the user's choice, which overrides everything.
        usual: the usual axis of this format, for bodies that are as wide as they are tall.

    Raises:
        CaptureError: a coordinate is too far away for any room, so the unit or the data are wrong.
    """
    _check_distance(positions_m)
    axis, sign, origin = _axis(positions_m, declared, chosen, usual)
    turned = turned_places(positions_m, axis)
    if sign == "-":
        turned = turned * _OVER
    guess = (
        f"The file names no upward axis: {axis} was guessed, along which the markers reach"
        " furthest. Choose another if the figure lies down."
    )
    notes = (guess,) if origin == "guessed" else ()
    label = axis if sign == "+" else f"-{axis}"
    return turned, Convention(f"{label} up, right-handed", origin), notes


def _axis(
    positions_m: FloatArray, declared: str | None, chosen: Up | None, usual: Up
) -> tuple[Up, Literal["+", "-"], Literal["file", "guessed", "chosen"]]:
    if chosen is not None:
        return chosen, "+", "chosen"
    word = (declared or "").strip().lower()
    for axis in _AXES:
        if word.endswith(axis) and word.strip("+-") == axis:
            return axis, "-" if word.startswith("-") else "+", "file"
    return _tallest(positions_m, usual), "+", "guessed"


def _tallest(positions_m: FloatArray, usual: Up) -> Up:
    """Return the axis with the largest extent of the markers, by the median over frames.

    `usual` is returned if no axis is clearly the longest.
    """
    step = max(1, len(positions_m) // _LOOKED_AT)
    some = positions_m[::step]
    seen = np.isfinite(some).all(axis=-1)
    some = some[seen.sum(axis=1) >= 2]
    if some.size == 0:
        return usual
    unseen = np.isnan(some)
    extents = np.where(unseen, -np.inf, some).max(axis=1) - np.where(unseen, np.inf, some).min(1)
    extent = np.median(extents, axis=0)
    least, tallest = np.argsort(extent)[-2:]
    clear = extent[tallest] >= _CLEARLY_TALLER * extent[least]
    return _AXES[int(tallest)] if clear else usual


def _check_distance(positions_m: FloatArray) -> None:
    seen = positions_m[np.isfinite(positions_m)]
    if seen.size and float(np.abs(seen).max()) > _FARTHEST_M:
        raise CaptureError(
            f"a marker lies {float(np.abs(seen).max()):.3g} m from the origin: the unit is another"
            " than was read, or the file is damaged."
        )
