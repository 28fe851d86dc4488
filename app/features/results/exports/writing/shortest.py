"""Find the shortest text that identifies a number in single precision, for millions at once.

Importing this module loads the compiler.
"""

import numpy as np
from numpy.typing import NDArray

from app.science.compiled import compiled

_POWERS: NDArray[np.float64] = 10.0 ** np.arange(23, dtype=np.float64)
"""Powers of ten, exact in double precision up to 10^22, so a quotient is rounded only once."""
_HIGH = np.array([float(10**power) for power in range(48)])
_LOW = np.array([float(10**power - int(float(10**power))) for power in range(48)])
"""Higher powers of ten as sums of two doubles."""
_SPLITTER = 2.0**27 + 1.0
_MIN_DIGITS, _MAX_DIGITS = 6, 9


def shortest_doubles(values: NDArray[np.float32]) -> NDArray[np.float64]:
    """Return the doubles, of the same shape, whose shortest text is that of the single `values`.

    0.1 in single precision is 0.100000001490116..., but "0.1" already identifies it. Six
    significant digits identify at most one single-precision number, nine always suffice (Steele and
    White 1990), so each value is rounded to 6, 7, 8 and 9 digits, and the first decimal that
    converts back to the value is taken. The result is the double nearest to that decimal, whose own
    shortest text is the decimal: any printer of doubles then prints it.

    Zeros keep their sign; values that are not finite are unchanged.
    """
    result = np.empty(values.shape)
    flat = np.ascontiguousarray(values).reshape(-1)
    rare = np.flatnonzero(_round_usual(flat, _POWERS, result.reshape(-1)))
    if len(rare):
        result.reshape(-1)[rare] = _shortest_of_rare(flat[rare])
    return result


@compiled
def _round_usual(
    values: NDArray[np.float32], powers: NDArray[np.float64], result: NDArray[np.float64]
) -> NDArray[np.bool_]:
    """Fill the results (n,) of most values (n,); return which are left to be found."""
    left = np.zeros(len(values), np.bool_)
    for at in range(len(values)):
        value = values[at]
        exact = np.float64(value)
        size = abs(exact)
        result[at] = exact
        # Where nine digits are a whole number below 2^53 after scaling by an exact power of ten.
        if not 1e-13 < size < 1e5:
            left[at] = 0.0 < size < np.inf
            continue
        scale = powers[_MIN_DIGITS - 1 - int(np.floor(np.log10(size)))]
        left[at] = True
        for _ in range(_MIN_DIGITS, _MAX_DIGITS + 1):
            rounded = np.rint(exact * scale) / scale
            if np.float32(rounded) == value:
                result[at] = rounded
                left[at] = False
                break
            scale *= 10.0
    return left


def _shortest_of_rare(values: NDArray[np.float32]) -> NDArray[np.float64]:
    """Return the doubles (n,) of values (n,) of any size, as `shortest_doubles` does.

    Rotations that should be zero are often about 1e-20, so these are computed together, too. A
    quotient by an inexact power of ten is corrected by its remainder (Dekker 1971).
    """
    exact = values.astype(np.float64)
    size = np.abs(exact)
    # Normal singles whose powers of ten are in the table. Of powers of two, the nearest decimal is
    # not always the shortest, because their neighbours are not equally far away.
    tiny = (size > 1e-37) & (size <= 1e-13) & (np.frexp(size)[0] != 0.5)
    power = _MIN_DIGITS - 1 - _exponents(np.where(tiny, size, 1.0))
    digits, chosen = np.zeros_like(exact), np.zeros_like(power)
    todo = tiny
    for _ in range(_MIN_DIGITS, _MAX_DIGITS + 1):
        scale = _HIGH[power]
        whole = np.rint(exact * scale)
        found = todo & ((whole / scale).astype(np.float32) == values)
        np.copyto(digits, whole, where=found)
        np.copyto(chosen, power, where=found)
        todo = todo & ~found
        power += 1
    result = _quotients(digits, _HIGH[chosen], _LOW[chosen])
    others = todo | ~tiny
    if others.any():
        result[others] = [float(str(value)) for value in values[others]]
    return result


def _exponents(size: NDArray[np.float64]) -> NDArray[np.intp]:
    exponents: NDArray[np.intp] = np.floor(np.log10(size)).astype(np.intp)
    return exponents


def _quotients(
    whole: NDArray[np.float64], high: NDArray[np.float64], low: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Return the doubles nearest to whole / (high + low), where `low` is below an ulp of `high`."""
    near = whole / high
    near_top, near_rest = _halves(near)
    high_top, high_rest = _halves(high)
    product = near * high
    rounding = near_rest * high_rest - (
        ((product - near_top * high_top) - near_rest * high_top) - near_top * high_rest
    )
    remainder = ((whole - product) - rounding) - near * low
    nearest: NDArray[np.float64] = near + remainder / high
    return nearest


def _halves(values: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Split doubles into two of at most 26 bits each (Veltkamp), so that products are exact."""
    scaled = values * _SPLITTER
    top = scaled - (scaled - values)
    return top, values - top
