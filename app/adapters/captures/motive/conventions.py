"""Determine the timing and the unit of length of a take.

Rows are timed by frame number and rate, because the times in the file are rounded. The unit is
taken from the settings, or else chosen so that the positions fit into a room.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.adapters.captures.capture import CaptureError, Convention, Limits, Reading
from app.adapters.captures.motive.head import Head
from app.adapters.captures.motive.values import TakeValues
from app.adapters.captures.units import chosen_length

_AGREES = 0.02
_UNITS = {
    "meters": ("m", 1.0),
    "centimeters": ("cm", 0.01),
    "millimeters": ("mm", 0.001),
    "inches": ("inch", 0.0254),
    "feet": ("foot", 0.3048),
}


@dataclass(frozen=True, eq=False)
class Timing:
    """The timing of a take's rows.

    Attributes:
        rate_hz: frame rate of the grid.
        slots: (N,) index of each row on a regular grid from 0; missing frames leave gaps.
        rate: the convention of the sampling rate.
        notes: notes on rates and missing frames.
    """

    rate_hz: float
    slots: npt.NDArray[np.int64]
    rate: Convention
    notes: tuple[str, ...]

    @property
    def frame_count(self) -> int:
        """Number of frames on the grid."""
        return int(self.slots[-1]) + 1


def time_rows(head: Head, values: TakeValues, limits: Limits) -> Timing:
    """Map the rows to a regular grid.

    The rate is that of the export or of the capture, whichever matches the times; if neither does,
    it is computed from the times.

    Raises:
        CaptureError: no rate is given or can be computed from the times, or too many frames are
            missing.
    """
    steps = np.diff(values.frames)
    step = float(np.min(steps)) if steps.size else 1.0
    slots = np.rint((values.frames - values.frames[0]) / step).astype(np.int64)
    size, rows = int(slots[-1]) + 1, len(slots)
    tracks = max(values.places.shape[1], 1)
    if size > 4 * rows + 1000 or size * tracks * 7 > limits.values:
        raise CaptureError(f"frames {values.frames[0]:g} to {values.frames[-1]:g} in {rows} rows.")
    rate_hz, notes = _rate(head, values, slots)
    if size > rows:
        notes.append(f"{size - rows} frames are missing from the numbering.")
    return Timing(rate_hz, slots, Convention(f"{rate_hz:.6g} Hz", "file"), tuple(notes))


def _rate(head: Head, values: TakeValues, slots: npt.NDArray[np.int64]) -> tuple[float, list[str]]:
    export, capture = head.rate("export frame rate"), head.rate("capture frame rate")
    stated = [rate for rate in (export, capture) if rate is not None]
    span = float(values.times_s[-1] - values.times_s[0])
    by_times = float(slots[-1]) / span if np.isfinite(span) and span > 0.0 else None
    notes = []
    if export and capture and abs(export - capture) > _AGREES * capture:
        notes.append(f"Captured at {capture:g} Hz, exported at {export:g} Hz.")
    if by_times is None or not 0.01 <= by_times <= 1e5:
        if not stated:
            raise CaptureError("neither the settings nor the times give the frame rate.")
        return stated[0], notes
    for rate in stated:
        if abs(rate - by_times) <= max(_AGREES * by_times, by_times * 2e-3 / span):
            return rate, notes
    if stated:
        notes.append(f"The times give {by_times:.4g} Hz, the settings {stated[0]:g} Hz.")
    return by_times, notes


def length_of(head: Head, values: TakeValues, reading: Reading) -> tuple[float, Convention]:
    """Return metres per unit, and the origin of that value.

    Raises:
        CaptureError: the settings name an unknown unit.
    """
    chosen = chosen_length(reading)
    if chosen is not None and reading.metres_per_unit is not None:
        return reading.metres_per_unit, chosen
    unit = head.settings.get("length units", "").lower()
    if unit:
        if unit not in _UNITS:
            raise CaptureError(
                f"length units {unit[:40]!r}: {', '.join(_UNITS)} are valid.", line=1
            )
        name, scale = _UNITS[unit]
        return scale, Convention(name, "file")
    # People and props are between the floor and 3 m, so the 90th percentile reveals the unit.
    distances = np.abs(values.places[np.isfinite(values.places)])
    typical = float(np.percentile(distances, 90)) if distances.size else 1.0
    name, scale = _UNITS[
        "meters" if typical < 12 else "centimeters" if typical < 400 else "millimeters"
    ]
    return scale, Convention(name, "guessed")
