"""Read the markers of a C3D file.

We parse the few required parts ourselves: every size is checked against the file's length before
memory is allocated, which compiled readers do not guarantee for untrusted files.
"""

import numpy as np

from app.adapters.captures.c3d.labels import names_and_places
from app.adapters.captures.c3d.parameters import BLOCK, read_parameters
from app.adapters.captures.c3d.points import layout, read_points
from app.adapters.captures.capture import (
    Capture,
    CaptureError,
    Convention,
    Conventions,
    Limits,
    Reading,
)
from app.adapters.captures.units import checked_rate, unit_of_markers
from app.adapters.captures.upright import upright
from app.science.rig import MarkerMotion

_MAGIC = 0x50


def read_c3d(data: bytes, *, name: str, reading: Reading, limits: Limits) -> Capture:
    """Read the markers of a C3D file, without analogue channels and events.

    Args:
        data: the content of the file.
        name: the name of the file, for messages.
        reading: a unit or upward axis that overrides the file's.
        limits: the largest sizes that are accepted.

    Raises:
        CaptureError: the file is not C3D, damaged, truncated, or contains no marker that was ever
            visible.
    """
    _check_begin(data, name, limits)
    parameters = read_parameters(data)
    where = layout(data, parameters, limits)
    names, kept, notes = names_and_places(parameters, where.points)
    metres, length = unit_of_markers(parameters.text("POINT", "UNITS"), reading.metres_per_unit)
    with np.errstate(over="ignore"):
        places = read_points(data, where, kept) * metres
    seen = np.all(np.isfinite(places), axis=-1)
    if not seen.any():
        raise CaptureError(f"none of the {len(kept)} markers of {name} is seen in any frame.")
    positions, axes, guesses = upright(
        places, declared=parameters.text("POINT", "Y_SCREEN"), chosen=reading.up, usual="z"
    )
    rate = checked_rate(where.rate_hz)
    return Capture(
        format="c3d",
        motion=MarkerMotion(names, rate, positions),
        conventions=Conventions(
            length=length,
            axes=axes,
            rotations=Convention("none", "format"),
            rate=Convention(f"{rate:g} Hz", "file"),
        ),
        notes=(*notes, *where.notes, *guesses, *gaps_note(seen)),
    )


def gaps_note(seen: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]) -> tuple[str, ...]:
    """Describe the share of missing marker positions.

    `seen` (N, M) marks the positions that were visible.
    """
    missing = 1.0 - float(seen.mean())
    if missing == 0.0:
        return ()
    return (f"{100 * missing:.2g} % of the marker positions were not seen.",)


def _check_begin(data: bytes, name: str, limits: Limits) -> None:
    if len(data) > limits.bytes:
        raise CaptureError(f"{name} has {len(data)} bytes: up to {limits.bytes} are read.")
    if len(data) < 2 * BLOCK or data[1] != _MAGIC:
        raise CaptureError(
            f"{name} is no C3D file: one begins with a header of {BLOCK} bytes whose second byte"
            " is 80, followed by a parameter section."
        )
