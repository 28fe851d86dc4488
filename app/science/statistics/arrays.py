"""Check and rank the arrays on which analyses work: a row per subject, a column per level."""

import numpy as np
import numpy.typing as npt

from app.science.statistics.errors import ConstantData, StatisticsError, TooFewData

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]
DIGITS = 11
"""Digits to which differences that are equal count as equal."""


def complete_blocks(values: npt.ArrayLike, *, least: int = 2) -> FloatArray:
    """Return complete blocks as (n subjects, k levels), with n and k at least `least`, all finite.

    Raises StatisticsError for another shape or values that are missing or infinite (leave them out
    by a stated rule first: `complete_rows`), TooFewData for too few rows or columns.
    """
    blocks = np.asarray(values, dtype=np.float64)
    if blocks.ndim != 2:
        raise StatisticsError(
            f"Blocks of shape {blocks.shape} were given; give one row per subject and one column"
            " per level."
        )
    n, k = blocks.shape
    if n < least or k < 2:
        raise TooFewData(
            f"{n} complete subjects and {k} levels are too few; at least {least} subjects and 2"
            " levels are needed."
        )
    if not np.isfinite(blocks).all():
        raise StatisticsError(
            "A value is missing or infinite. Leave its subject out by a stated rule first."
        )
    return blocks


def complete_rows(values: npt.ArrayLike) -> tuple[FloatArray, int]:
    """Return the rows without a missing value, and how many were left out (listwise)."""
    rows = np.asarray(values, dtype=np.float64)
    complete = ~np.isnan(rows.reshape(rows.shape[0], -1)).any(axis=1)
    return rows[complete], int(rows.shape[0] - complete.sum())


def comparable(differences: FloatArray, scale: float) -> FloatArray:
    """Round to 11 digits of `scale`, so that equal differences are equal.

    0.3 - 0.2 and 0.2 - 0.1 differ in the last binary digit, but must have the same rank.
    """
    if not scale > 0.0:
        return differences
    unit = 10.0 ** (np.floor(np.log10(scale)) + 1 - DIGITS)
    rounded: FloatArray = np.round(differences / unit)
    return rounded


def midranks(values: FloatArray) -> FloatArray:
    """Return the ranks 1..N of (N,) values; equal values share the mean of their ranks."""
    size = values.size
    order = np.argsort(values, kind="stable")
    ordered = values[order]
    first = np.empty(size, dtype=np.bool_)
    first[:1] = True
    np.not_equal(ordered[1:], ordered[:-1], out=first[1:])
    edges = np.append(np.flatnonzero(first), size)
    shared = 0.5 * (edges[1:] + edges[:-1] + 1)
    ranks = np.empty(size)
    ranks[order] = shared[np.cumsum(first) - 1]
    return ranks


def row_midranks(blocks: FloatArray) -> FloatArray:
    """Return the ranks 1..k within each row of (n, k); equal values share the mean rank."""
    across, down = blocks[:, np.newaxis, :], blocks[:, :, np.newaxis]
    less = (across < down).sum(axis=2)
    equal = (across == down).sum(axis=2)
    ranks: FloatArray = less + 0.5 * (equal + 1)
    return ranks


def require_ranks(ranks: FloatArray) -> None:
    """Raise ConstantData if nobody's ranks, of (n subjects, k levels), tell the levels apart."""
    n, k = ranks.shape
    if (ranks == 0.5 * (k + 1)).all():
        raise ConstantData(
            f"Each of {n} subjects has the same value at all {k} levels; there is nothing to rank."
        )
