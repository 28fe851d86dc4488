"""Compute scores from the instrument's own formulas, for one form or for a column of forms.

A missing answer is NaN, and so is every value computed from it: a score with a missing item has no
value. A division by zero gives no value either, nor does a result too large for a float.
"""

import math
from collections.abc import Mapping
from functools import reduce

import numpy as np
from numpy.typing import NDArray

from app.science.instruments.answers import as_number
from app.science.instruments.errors import AnswerError
from app.science.instruments.formula import Binary, Call, Name, Negative, Node, Number
from app.science.instruments.instrument import Instrument

FloatArray = NDArray[np.float64]


def score_answers(instrument: Instrument, answers: Mapping[str, object]) -> dict[str, float | None]:
    """Return every score of one completed form, in the instrument's order; None if it has no value.

    `answers`: raw, as answered (before recoding). Texts and choices are ignored. A score is None if
    one of its items is missing or a division by zero occurs. Raises AnswerError for an invalid
    answer and for a key that is not an item.
    """
    unknown = [key for key in answers if key not in instrument.by_key]
    if unknown:
        valid = "an answer to one of the items " + ", ".join(instrument.by_key)
        raise AnswerError(unknown[0], answers[unknown[0]], valid)
    columns = {
        item.key: np.array([as_number(instrument, item, answers.get(item.key))])
        for item in instrument.items
        if item.is_numeric
    }
    scores = scores_of_columns(instrument, columns, rows=1)
    return {
        key: None if math.isnan(column[0]) else float(column[0]) for key, column in scores.items()
    }


def scores_of_columns(
    instrument: Instrument, columns: Mapping[str, FloatArray], *, rows: int
) -> dict[str, FloatArray]:
    """Return scores (rows,) from columns of raw answers (rows,); absent items count as missing."""
    missing = np.full(rows, np.nan)
    raw = {item.key: columns.get(item.key, missing) for item in instrument.items if item.is_numeric}
    values = _recoded(instrument, raw)
    scores: dict[str, FloatArray] = {}
    for key, tree in instrument.formulas.items():
        scores[key] = np.broadcast_to(evaluate(tree, values | scores), rows)
    return scores


def _recoded(instrument: Instrument, raw: dict[str, FloatArray]) -> dict[str, FloatArray]:
    """Recode all items in one operation: the formula is the same for each."""
    if instrument.recoding is None or not raw:
        return raw
    together = np.stack(list(raw.values()))
    recoded = np.broadcast_to(evaluate(instrument.recoding, {"x": together}), together.shape)
    return dict(zip(raw, recoded, strict=True))


def evaluate(node: Node, values: Mapping[str, FloatArray]) -> FloatArray:
    """Evaluate a formula elementwise.

    `values`: arrays of one common shape, float64, NaN where missing. The result has their shape, or
    shape () for a formula without names. It is finite or NaN.
    """
    with np.errstate(all="ignore"):
        result = _evaluate(node, values)
        # Adding zero turns -0.0, which would look odd in a table, into 0.0.
        return np.asarray(np.where(np.isfinite(result), result + 0.0, np.nan), dtype=np.float64)


def _evaluate(node: Node, values: Mapping[str, FloatArray]) -> FloatArray:
    match node:
        case Number(value):
            return np.asarray(value, dtype=np.float64)
        case Name(key):
            return values[key]
        case Negative(operand):
            return np.negative(_evaluate(operand, values))
        case Binary(operator, left, right):
            return _binary(operator, _evaluate(left, values), _evaluate(right, values))
        case Call(function, arguments):
            return _call(function, [_evaluate(argument, values) for argument in arguments])


def _binary(operator: str, left: FloatArray, right: FloatArray) -> FloatArray:
    match operator:
        case "+":
            result = np.add(left, right)
        case "-":
            result = np.subtract(left, right)
        case "*":
            result = np.multiply(left, right)
        case _:
            result = np.divide(left, right)
    # After each operation, so that an infinity cannot become a number again, as in 1 / (1 / 0) = 0.
    return np.where(np.isfinite(result), result, np.nan)


def _call(function: str, arguments: list[FloatArray]) -> FloatArray:
    # np.minimum and np.maximum propagate NaN, as required for a missing item.
    match function:
        case "min":
            return reduce(np.minimum, arguments)
        case "max":
            return reduce(np.maximum, arguments)
        case "sum":
            return reduce(np.add, arguments)
        case _:
            return np.divide(reduce(np.add, arguments), float(len(arguments)))
