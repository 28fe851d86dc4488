"""Means with their bootstrap intervals, in words; whoever computes them again gets the same."""

import numpy as np

from app.features.results.analysis.questions.words import number
from app.science.statistics import (
    FloatArray,
    Interval,
    StatisticsError,
    bootstrap_interval,
    mean_of,
)

SEED, DRAWS = 20_260_101, 1999


def mean_words(values: FloatArray) -> str:
    """The mean and its interval in brackets; without an interval where there is too little."""
    found = _found(values)
    if found is None:
        return number(float(values.mean())) if values.size else number(None)
    return f"{number(found.estimate)} {_ends(found)}"


def interval_words(values: FloatArray) -> str:
    """The interval of the mean; a dash where there is too little."""
    found = _found(values)
    return number(None) if found is None else _ends(found)


def _found(values: FloatArray) -> Interval | None:
    rng = np.random.default_rng(SEED)
    try:
        return bootstrap_interval(values, mean_of, rng=rng, resamples=DRAWS)
    except StatisticsError:
        return None


def _ends(found: Interval) -> str:
    return f"[{number(found.low)}, {number(found.high)}]"
