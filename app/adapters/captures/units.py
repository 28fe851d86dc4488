"""Units of length: from the file, chosen by the user, or guessed from the size of a body."""

import math
from dataclasses import dataclass

from app.adapters.captures.capture import CaptureError, Convention, Reading

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
_NAMED: tuple[tuple[str, float], ...] = (
    ("cm", 0.01),
    ("m", 1.0),
    ("mm", 0.001),
    ("0.056444 m", 0.056444),  # the unit of the CMU captures: 1/0.45 inch
    ("inch", 0.0254),
)
_PLAUSIBLE_M = (0.85, 2.4)
_ADULT_M = 1.7


def unit_of_markers(
    word: str | None, chosen: float | None, *, line: int = 0
) -> tuple[float, Convention]:
    """Return metres per unit and its origin; millimetres are guessed if the file names no unit.

    Raises:
        CaptureError: the file names an unknown unit.
    """
    if chosen is not None:
        return chosen, Convention(f"{chosen:g} m", "chosen")
    unit = (word or "").strip().lower()
    if not unit:
        return 0.001, Convention("mm", "guessed")
    if unit not in METRES_IN:
        raise CaptureError(
            f"the unit {unit[:40]!r} is not known: valid are {', '.join(METRES_IN)}; or say how"
            " many metres a unit has.",
            line=line,
        )
    return METRES_IN[unit], Convention(unit, "file")


def checked_rate(rate_hz: float, *, line: int = 0) -> float:
    """Return the rate; raise CaptureError if it is implausible for a camera."""
    if not (math.isfinite(rate_hz) and 0.0 < rate_hz <= HIGHEST_RATE_HZ):
        raise CaptureError(
            f"the rate is {rate_hz:g} Hz: above 0 up to {HIGHEST_RATE_HZ:g} is valid.", line=line
        )
    return rate_hz


@dataclass(frozen=True)
class GuessedLength:
    """A guessed unit, the body's size in metres by it, and whether that is a human's size."""

    name: str
    metres_per_unit: float
    size_m: float
    plausible: bool


def guess_length(size: float) -> GuessedLength:
    """Guess the unit from a body's size in that unit: its largest extent in the rest pose.

    It is the first of cm, m, mm, CMU's unit and inch that gives a person of 0.85 to 2.4 m; if none
    does, the one that comes nearest to 1.7 m; cm for a body without extent.
    """
    for name, scale in _NAMED:
        if _PLAUSIBLE_M[0] <= size * scale <= _PLAUSIBLE_M[1]:
            return GuessedLength(name, scale, size * scale, plausible=True)
    if not size > 1e-9:
        return GuessedLength("cm", 0.01, max(size, 0.0) * 0.01, plausible=False)
    name, scale = min(_NAMED, key=lambda unit: max(size * unit[1], _ADULT_M**2 / (size * unit[1])))
    return GuessedLength(name, scale, size * scale, plausible=False)


def unit_name(metres_per_unit: float) -> str:
    """Return the name of a unit of this length in metres, such as "cm" for 0.01."""
    for name, scale in _NAMED:
        if abs(scale - metres_per_unit) <= 1e-9:
            return name
    return f"{metres_per_unit:.6g} m"


def chosen_length(reading: Reading) -> Convention | None:
    """Return the unit that the user chose, if any."""
    if reading.metres_per_unit is None:
        return None
    return Convention(unit_name(reading.metres_per_unit), "chosen")


def chosen_axes(reading: Reading, default: Convention, handed: str = "right-handed") -> Convention:
    """Return the upward axis that the user chose, or else the format's default."""
    if reading.up is None:
        return default
    return Convention(f"{reading.up} up, {handed}", "chosen")
