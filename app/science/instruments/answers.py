"""Validation of answers: for forms (all problems at once) and for scoring (as numbers).

Forms on which somebody gave one rating throughout are valid, but studies may exclude them.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.science.instruments.errors import AnswerError, shortened
from app.science.instruments.instrument import Instrument
from app.science.instruments.item_checks import DEFAULT_TEXT_LENGTH
from app.science.instruments.items import Item

FEWEST_RATINGS = 5
"""Fewest ratings of a form for which identical ratings count as straight-lining."""
USUAL_MISSING_CODES = frozenset(
    {-9999, -999, -888, -777, -99, -98, -97, -88, -77, -9, -8, -1}
    | {77, 88, 97, 98, 99, 777, 888, 999, 9999}
)
"""Numbers that questionnaires and statistics programs often store for a missing answer."""
_NUMBERS = (int, float, np.integer, np.floating)


@dataclass(frozen=True)
class AnswerProblem:
    """The reason why one answer is rejected, with the valid answers and a remedy."""

    item: str
    message: str
    value: object
    valid: str
    remedy: str


def validate_answers(
    instrument: Instrument, answers: Mapping[str, object]
) -> tuple[AnswerProblem, ...]:
    """Return every problem of a completed form, in the order of the items; empty if it is valid.

    `answers`: item key -> number, text, True/False, choice key; None or absent for no answer. Whole
    numbers may be given as floats (3.0).
    """
    problems: list[AnswerProblem] = []
    for item in instrument.items:
        value = answers.get(item.key)
        valid = valid_answers(instrument, item)
        if value is None or (isinstance(value, str) and not value.strip()):
            if item.required:
                message = "An answer is missing."
                problems.append(
                    AnswerProblem(item.key, message, value, valid, "Answer this question.")
                )
        elif not fits(instrument, item, value):
            message = f"The answer {shortened(value)!r} is not possible here."
            problems.append(AnswerProblem(item.key, message, value, valid, f"Give {valid}."))
    item_keys = ", ".join(instrument.by_key)
    problems.extend(
        AnswerProblem(
            str(key), "There is no such question.", answers[key], item_keys, "Leave it out."
        )
        for key in answers
        if key not in instrument.by_key
    )
    return tuple(problems)


def fits(instrument: Instrument, item: Item, value: object) -> bool:
    """Return whether a value that is not missing is a valid answer to the item."""
    if item.type == "text":
        limit = DEFAULT_TEXT_LENGTH if item.max_length is None else item.max_length
        return isinstance(value, str) and len(value) <= limit and "\0" not in value
    if item.type == "choice":
        return value in [choice.key for choice in item.choices]
    if item.type == "boolean":
        return isinstance(value, bool | np.bool_)
    if isinstance(value, bool) or not isinstance(value, _NUMBERS) or not math.isfinite(value):
        return False
    number = float(value)
    scale = instrument.scale_of(item)
    if scale is not None:
        return number.is_integer() and int(number) in scale.steps
    low, high = _limits(item)
    return (item.type == "number" or number.is_integer()) and low <= number <= high


def valid_answers(instrument: Instrument, item: Item) -> str:
    """Describe the valid answers to an item, for messages: "a whole number from 1 to 7"."""
    if item.type == "text":
        return f"text of at most {item.max_length or DEFAULT_TEXT_LENGTH} characters"
    if item.type == "choice":
        return "one of " + ", ".join(choice.key for choice in item.choices)
    if item.type == "boolean":
        return "true or false"
    scale = instrument.scale_of(item)
    if scale is not None:
        stepped = "" if scale.step == 1 else f" in steps of {scale.step}"
        return f"a whole number from {scale.minimum} to {scale.maximum}{stepped}"
    low, high = _limits(item)
    words = "a number" if item.type == "number" else "a whole number"
    if math.isfinite(low) and math.isfinite(high):
        words += f" from {low:g} to {high:g}"
    elif math.isfinite(low):
        words += f" of at least {low:g}"
    elif math.isfinite(high):
        words += f" of at most {high:g}"
    return words if item.unit is None else f"{words} {item.unit}"


def as_number(
    instrument: Instrument, item: Item, value: object, *, row: int | None = None
) -> float:
    """Return an answer as a raw number for the formulas; NaN if missing, 1 and 0 for yes and no.

    Raises AnswerError for a value that is not a valid answer; `row` is passed on to it.
    """
    if value is None or (isinstance(value, _NUMBERS) and math.isnan(value)):
        return math.nan
    # Tables may encode a yes as 1.
    if item.type == "boolean" and not isinstance(value, bool) and value in (0, 1):
        value = bool(value)
    if not item.is_numeric or not fits(instrument, item, value):
        raise AnswerError(item.key, value, valid_answers(instrument, item), row=row)
    return float(value)  # type: ignore[arg-type]  # `fits` has shown that it is a number


def _limits(item: Item) -> tuple[float, float]:
    low = -math.inf if item.minimum is None else item.minimum
    high = math.inf if item.maximum is None else item.maximum
    return low, high


def straight_lined(ratings: NDArray[np.float64], *, one_sided: bool) -> NDArray[np.bool_]:
    """Return for each form whether all its ratings are identical.

    Args:
        ratings: (..., items) raw ratings of complete forms.
        one_sided: whether all items of the instrument point the same way. Then the lowest rating,
            0, can be an honest answer to all of them, and does not count.

    Returns:
        (...) True for a straight-lined form; all False for fewer than `FEWEST_RATINGS` items.
    """
    if ratings.shape[-1] < FEWEST_RATINGS:
        return np.zeros(ratings.shape[:-1], dtype=np.bool_)
    alike: NDArray[np.bool_] = (ratings == ratings[..., :1]).all(axis=-1)
    return alike & (ratings[..., 0] != 0.0) if one_sided else alike
