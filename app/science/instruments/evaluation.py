"""From a formula's tree to its value, for one person or for a column of people at once.

A missing answer is NaN, and whatever it enters becomes NaN: a score with a missing item has no
value. Dividing by zero gives no value either, and neither does a result too large for a float.
"""

from collections.abc import Mapping
from functools import reduce

import numpy as np
from numpy.typing import NDArray

from app.science.instruments.formula import Binary, Call, Name, Negative, Node, Number

FloatArray = NDArray[np.float64]


def evaluate(node: Node, values: Mapping[str, FloatArray]) -> FloatArray:
    """Value of a formula, elementwise.

    `values`: arrays of one common shape, float64, NaN where missing. The result has their shape, or
    shape () for a formula without names. It is finite or NaN.
    """
    with np.errstate(all="ignore"):
        result = _evaluate(node, values)
        # Adding zero turns -0.0 into 0.0, which would look odd in a table.
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
    # At once, so that an infinity cannot creep back as a number, as in 1 / (1 / 0) = 0.
    return np.where(np.isfinite(result), result, np.nan)


def _call(function: str, arguments: list[FloatArray]) -> FloatArray:
    # np.minimum and np.maximum pass NaN on, as a missing item demands.
    match function:
        case "min":
            return reduce(np.minimum, arguments)
        case "max":
            return reduce(np.maximum, arguments)
        case "sum":
            return reduce(np.add, arguments)
        case _:
            return np.divide(reduce(np.add, arguments), float(len(arguments)))
