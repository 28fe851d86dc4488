"""Units of length as files write them."""

import math

from app.adapters.captures.capture import CaptureError, Convention

METRES_IN: dict[str, float] = {
    "mm": 0.001,
    "millimeters": 0.001,
    "millimetres": 0.001,
    "cm": 0.01,
    "centimeters": 0.01,
    "centimetres": 0.01,
    "dm": 0.1,
    "m": 1.0,
    "meters": 1.0,
    "metres": 1.0,
    "in": 0.0254,
    "inch": 0.0254,
    "inches": 0.0254,
    "ft": 0.3048,
}

HIGHEST_RATE_HZ = 100_000.0


def unit_of_markers(
    word: str | None, chosen: float | None, *, line: int = 0
) -> tuple[float, Convention]:
    """Return metres per unit and who says so; millimetres are guessed where a file is silent.

    Raises:
        CaptureError: the file names a unit that is none.
    """
    if chosen is not None:
        return chosen, Convention(f"{chosen:g} m", "chosen")
    told = (word or "").strip().lower()
    if not told:
        return 0.001, Convention("mm", "guessed")
    if told not in METRES_IN:
        raise CaptureError(
            f"the unit {told[:40]!r} is not known: valid are {', '.join(METRES_IN)}; or say how"
            " many metres a unit has.",
            line=line,
        )
    return METRES_IN[told], Convention(told, "file")


def checked_rate(rate_hz: float, *, line: int = 0) -> float:
    """Return the rate; raises CaptureError where no camera runs at it."""
    if not (math.isfinite(rate_hz) and 0.0 < rate_hz <= HIGHEST_RATE_HZ):
        raise CaptureError(
            f"the rate is {rate_hz:g} Hz: above 0 up to {HIGHEST_RATE_HZ:g} is valid.", line=line
        )
    return rate_hz
