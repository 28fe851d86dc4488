"""Solve a small quadratic programme with bounds, for one step of inverse kinematics.

    minimise  1/2 x' H x - b' x   with   low <= x <= high,

H symmetric and positive definite. Each unknown is free or held at a bound, and the free ones solve
their equations. Free unknowns that left their bounds are then wrong, and so are held ones that the
residual b - H x draws inwards. All wrong ones switch at the same time, as long as that makes their
number smaller than ever before, with three attempts to spare; after those only the last of them
switches, which is slow but always terminates. The solution is unique, so it does not depend on the
order of the switches. A moving body needs few of them; `MAX_PASSES` is a safety limit.

Source: block principal pivoting, Judice and Pires (1994), Computers & Operations Research 21(5),
587-596.
"""

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray

MAX_PASSES = 200
_SPARE_ATTEMPTS = 3
_TOLERANCE = 1e-12
_Flags = npt.NDArray[np.bool_]


def bounded_step(
    hessian: FloatArray, linear: FloatArray, low: FloatArray, high: FloatArray
) -> FloatArray:
    """Return the x (n,) that minimises the programme in the module docstring.

    Args:
        hessian: the matrix H, (n, n).
        linear: the vector b, (n,).
        low, high: the bounds of x, (n,).
    """
    at_low: _Flags = np.zeros(len(linear), dtype=np.bool_)
    at_high = at_low.copy()
    step = np.asarray(np.linalg.solve(hessian, linear))
    fewest, spare = len(linear) + 1, _SPARE_ATTEMPTS
    for _ in range(MAX_PASSES):
        residual = linear - hessian @ step
        free = ~(at_low | at_high)
        below, above = free & (step < low - _TOLERANCE), free & (step > high + _TOLERANCE)
        inwards = (at_low & (residual > _TOLERANCE)) | (at_high & (residual < -_TOLERANCE))
        wrong = np.flatnonzero(below | above | inwards)
        if not len(wrong):
            break
        if len(wrong) < fewest:
            fewest, spare = len(wrong), _SPARE_ATTEMPTS
        elif spare > 0:
            spare -= 1
        else:
            wrong = wrong[-1:]
        at_low[wrong], at_high[wrong] = below[wrong], above[wrong]
        step = _solve_free(hessian, linear, at_low | at_high, np.where(at_low, low, high))
    return np.clip(step, low, high)


def _solve_free(
    hessian: FloatArray, linear: FloatArray, held: _Flags, bounds: FloatArray
) -> FloatArray:
    step = np.where(held, bounds, 0.0)
    free = np.flatnonzero(~held)
    if len(free):
        remaining = linear[free] - hessian[free] @ step
        step[free] = np.linalg.solve(hessian[np.ix_(free, free)], remaining)
    return step
