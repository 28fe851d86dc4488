"""The exact null distribution of Friedman's test, with ties.

Without an effect every arrangement of a subject's ranks over the levels is equally likely, whether
or not there are ties. So the distribution of the column sums is a convolution over subjects.
Because all arrangements are equally likely, a state and its permutations stay equally likely too:
states are kept sorted, which leaves about one in k! of them. Ranks are doubled, so that all sums
are whole numbers and rounding errors cannot affect comparisons.
"""

from functools import lru_cache
from itertools import permutations

import numpy as np
import numpy.typing as npt

from app.science.statistics.arrays import FloatArray, IntArray

_MOST_ROWS = 4_000_000
"""Largest number of rows in a step; 5 levels without ties reach it at 13 subjects."""
_MOST_LEVELS = 8
"""With more levels, even the arrangements of one subject need too much memory."""
Pattern = tuple[int, ...]
_States = npt.NDArray[np.int16]


def exact_tail(ranks: FloatArray) -> float | None:
    """Return P of a Friedman statistic at least as large as that of these (n, k) midranks.

    None if the distribution is too large to be enumerated.
    """
    if ranks.shape[1] > _MOST_LEVELS:
        return None
    doubled = np.rint(2.0 * ranks).astype(np.int64)
    doubled -= doubled.min(axis=1, keepdims=True)
    if not (doubled & 1).any():
        doubled >>= 1
    rows = np.sort(doubled, axis=1).tolist()
    distribution = _distribution(tuple(sorted(tuple(row) for row in rows)))
    if distribution is None:
        return None
    spreads, tails = distribution
    seen = _spread(doubled.sum(axis=0)[np.newaxis])[0]
    return float(tails[np.searchsorted(spreads, seen)])


def _spread(sums: IntArray) -> IntArray:
    """Return k times the sum of squares of (m, k) column sums about their mean: grows with Q."""
    k = sums.shape[1]
    spread: IntArray = k * (sums * sums).sum(axis=1) - sums.sum(axis=1) ** 2
    return spread


@lru_cache(maxsize=512)
def _distribution(patterns: tuple[Pattern, ...]) -> tuple[IntArray, FloatArray] | None:
    """Return the possible spreads, ascending, and the probability of each or a larger one."""
    # The first subject's arrangement can be fixed, because only arrangements relative to it matter.
    states: _States = np.array(patterns[:1], dtype=np.int16)
    chances = np.ones(1)
    for pattern in patterns[1:]:
        moves = _arrangements(pattern)
        if states.shape[0] * moves.shape[0] > _MOST_ROWS:
            return None
        states, chances = _step(states, chances, moves)
    spreads, place = np.unique(_spread(states.astype(np.int64)), return_inverse=True)
    tails = np.cumsum(np.bincount(place, weights=chances)[::-1])[::-1]
    return spreads, np.minimum(tails, 1.0)


@lru_cache(maxsize=256)
def _arrangements(pattern: Pattern) -> _States:
    """Return the distinct orders of a pattern, which are all equally likely."""
    return np.array(sorted(set(permutations(pattern))), dtype=np.int16)


def _step(states: _States, chances: FloatArray, moves: _States) -> tuple[_States, FloatArray]:
    """Add one subject in every arrangement, merging states that are permutations of each other."""
    k = states.shape[1]
    sums = (states[:, np.newaxis] + moves).reshape(-1, k)
    sums.sort(axis=1)
    keys = sums[:, 0].astype(np.int64)
    # The last sum follows from the total.
    for column in range(1, k - 1):
        keys = keys * (int(sums.max()) + 1) + sums[:, column]
    _, first, place = np.unique(keys, return_index=True, return_inverse=True)
    weights = np.repeat(chances / moves.shape[0], moves.shape[0])
    joined: FloatArray = np.bincount(place, weights=weights).astype(np.float64)
    return sums[first], joined
