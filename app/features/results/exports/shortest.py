"""Single-precision numbers as the shortest decimals that read back as the same numbers.

0.1 in single precision is 0.100000001490116..., but "0.1" already names it. Six significant digits
name at most one single-precision number, nine always suffice (Steele and White 1990), so each value
is rounded to 6, 7, 8 and 9 digits, for all values at once, and the first decimal that converts back
to the value is taken. It is given as the double nearest to that decimal, whose own shortest text is
the decimal: any printer of doubles then prints it.
"""

import numpy as np
from numpy.typing import NDArray

_POWERS = 10.0 ** np.arange(23)
"""Exact in double precision up to 10^22, so a quotient by one of them is rounded only once."""
_FEWEST, _MOST = 6, 9


def shortest_doubles(values: NDArray[np.float32]) -> NDArray[np.float64]:
    """The doubles, of the same shape, whose shortest text is that of the single `values`.

    Zeros keep their sign; values that are not finite stay as they are.
    """
    exact = values.astype(np.float64)
    size = np.abs(exact)
    # Where nine digits are a whole number below 2^53 after scaling by an exact power of ten.
    usual = (size > 1e-13) & (size < 1e5)
    exponent = np.floor(np.log10(np.where(usual, size, 1.0))).astype(np.int64)
    result = exact.copy()
    todo = usual
    for digits in range(_FEWEST, _MOST + 1):
        scale = _POWERS[digits - 1 - exponent]
        rounded = np.rint(exact * scale) / scale
        found = todo & (rounded.astype(np.float32) == values)
        result[found] = rounded[found]
        todo = todo & ~found
    rare = (todo | ~usual) & np.isfinite(exact) & (exact != 0.0)
    if rare.any():
        result[rare] = [float(str(value)) for value in values[rare]]
    return result
