"""What a bare word in a configuration file means: the core schema of YAML 1.2, a little stricter.

YAML 1.1 (which most Python readers follow) turns `no` into False, 12:30 into 750 and 010 into 8.
Here only true and false are booleans, only decimal numbers are numbers, and all else is text.
"""

import math
import re
from dataclasses import dataclass

_INTEGER = re.compile(r"[-+]?(0|[1-9][0-9]*)")
_NUMBER = re.compile(r"[-+]?(\.[0-9]+|(0|[1-9][0-9]*)(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_NOT_FINITE = re.compile(r"[-+]?\.?(inf|infinity|nan)", re.IGNORECASE)
_WORDS: dict[str, bool | None] = {
    "": None, "~": None, "null": None, "Null": None, "NULL": None,
    "true": True, "True": True, "TRUE": True,
    "false": False, "False": False, "FALSE": False,
}  # fmt: skip
_FORBIDDEN = re.compile(r"[\x00-\x08\x0b-\x1f\x7f\ud800-\udfff]")

# Whole numbers beyond this are not the same in every reader of JSON.
MAX_INTEGER = 2**53 - 1
_MAX_DIGITS = 40


@dataclass(frozen=True)
class ScalarProblem:
    """Why a scalar cannot be taken."""

    message: str
    remedy: str


def scalar_problem(text: str, *, plain: bool) -> ScalarProblem | None:
    """Why the scalar cannot be taken, or None. `plain`: unquoted, so that it may be a number."""
    found = _FORBIDDEN.search(text)
    if found is not None:
        return ScalarProblem(
            f"The text holds the control character U+{ord(found.group()):04X}.", "Remove it."
        )
    if not plain:
        return None
    if _NOT_FINITE.fullmatch(text):
        return ScalarProblem(
            f"{text} is not a finite number.", "Give a number, or put the word in quotes."
        )
    if _NUMBER.fullmatch(text) and not _is_representable(text):
        return ScalarProblem(
            f"The number {text[:20]} is too large.",
            f"Whole numbers go up to {MAX_INTEGER}; put it in quotes if it is a text.",
        )
    return None


def scalar_value(text: str) -> bool | int | float | str | None:
    """The value of an unquoted scalar that has no problem."""
    if text in _WORDS:
        return _WORDS[text]
    if _INTEGER.fullmatch(text):
        return int(text)
    if _NUMBER.fullmatch(text):
        return float(text) + 0.0  # -0.0 becomes 0.0: one number, one hash
    return text


def _is_representable(text: str) -> bool:
    if len(text) > _MAX_DIGITS:
        return False
    if _INTEGER.fullmatch(text):
        return abs(int(text)) <= MAX_INTEGER
    return math.isfinite(float(text))
