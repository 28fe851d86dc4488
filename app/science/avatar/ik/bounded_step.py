"""The best step within bounds: a small quadratic programme.

    minimise  1/2 x' H x - b' x   with   low <= x <= high,

H symmetric and positive definite. Each unknown is free or held at a bound, and the free ones solve
their equations. Wrong are then the free ones that left their bounds, and the held ones that the
remaining pull b - H x draws inwards. All wrong ones change sides at once, as long as that makes
their number smaller than it ever was, with three attempts to spare; after those only the last of
them changes, which is slow and always ends. The solution is unique, so it does not depend on the
way there. A moving body needs few changes, `MOST_PASSES` are for its safety.

Source: block principal pivoting, Judice and Pires (1994), Computers & Operations Research 21(5),
587-596.
"""

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray

MOST_PASSES = 200
_SPARE_ATTEMPTS = 3
_TOLERANCE = 1e-12
_Flags = npt.NDArray[np.bool_]


def bounded_step(
    hessian: FloatArray, pull: FloatArray, low: FloatArray, high: FloatArray
) -> FloatArray:
    """Return x, shape (n,), for `hessian` (n, n) and `pull`, `low`, `high` (n,)."""
    at_low: _Flags = np.zeros(len(pull), dtype=np.bool_)
    at_high = at_low.copy()
    step = np.asarray(np.linalg.solve(hessian, pull))
    fewest, spare = len(pull) + 1, _SPARE_ATTEMPTS
    for _ in range(MOST_PASSES):
        left = pull - hessian @ step
        free = ~(at_low | at_high)
        below, above = free & (step < low - _TOLERANCE), free & (step > high + _TOLERANCE)
        inwards = (at_low & (left > _TOLERANCE)) | (at_high & (left < -_TOLERANCE))
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
        step = _with_held(hessian, pull, at_low | at_high, np.where(at_low, low, high))
    return np.clip(step, low, high)


def _with_held(
    hessian: FloatArray, pull: FloatArray, held: _Flags, bounds: FloatArray
) -> FloatArray:
    step = np.where(held, bounds, 0.0)
    free = np.flatnonzero(~held)
    if len(free):
        rest = pull[free] - hessian[free] @ step
        step[free] = np.linalg.solve(hessian[np.ix_(free, free)], rest)
    return step
