"""Whether there are too few people for any result: exact p cannot be as small as one likes."""

import math

from app.features.results.analysis.questions.words import bounded
from app.science.statistics import AgainstReference, Friedman


def signed_floor(found: AgainstReference) -> str:
    """Whether n is too small for any result: the smallest p that the test can give."""
    sides = 1.0 if found.alternative != "two-sided" else 2.0
    family = len(found.comparisons)
    most = max((one.test.n - one.test.n_zero for one in found.comparisons), default=0)
    floor = min(1.0, sides * family * 0.5**most)
    if floor <= found.alpha:
        return ""
    return (
        f"Too few participants for any result: with {most} differences other than zero and "
        f"{family} comparisons the smallest possible adjusted p is {bounded(floor)}, above α = "
        f"{bounded(found.alpha, 2)}."
    )


def friedman_floor(found: Friedman, alpha: float) -> str:
    """The same of Friedman's test, whose smallest exact p is k!^(1 - n)."""
    floor = float(math.factorial(found.df + 1)) ** (1 - found.n)
    if floor <= alpha:
        return ""
    return (
        f"Too few participants for any result: with {found.n} the smallest possible exact p is "
        f"{bounded(floor)}, above α = {bounded(alpha, 2)}."
    )
