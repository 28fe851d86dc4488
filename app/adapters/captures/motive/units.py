"""A take's unit of length: told by its settings, else what makes its numbers a room's."""

import numpy as np

from app.adapters.captures.capture import CaptureError, Convention, Reading
from app.adapters.captures.motive.head import Head
from app.adapters.captures.motive.values import TakeValues
from app.adapters.captures.unit_guess import chosen_length

_TOLD = {
    "meters": ("m", 1.0),
    "centimeters": ("cm", 0.01),
    "millimeters": ("mm", 0.001),
    "inches": ("inch", 0.0254),
    "feet": ("foot", 0.3048),
}


def length_of(head: Head, values: TakeValues, reading: Reading) -> tuple[float, Convention]:
    """Return metres per unit, and who says so.

    Raises:
        CaptureError: the settings tell a unit that does not exist.
    """
    said = chosen_length(reading)
    if said is not None and reading.metres_per_unit is not None:
        return reading.metres_per_unit, said
    told = head.settings.get("length units", "").lower()
    if told:
        if told not in _TOLD:
            raise CaptureError(f"length units {told[:40]!r}: {', '.join(_TOLD)} are valid.", line=1)
        name, scale = _TOLD[told]
        return scale, Convention(name, "file")
    # People and props are seen between the floor and 3 m, so that the 90th percentile tells.
    known = np.abs(values.places[np.isfinite(values.places)])
    typical = float(np.percentile(known, 90)) if known.size else 1.0
    name, scale = _TOLD[
        "meters" if typical < 12 else "centimeters" if typical < 400 else "millimeters"
    ]
    return scale, Convention(name, "guessed")
