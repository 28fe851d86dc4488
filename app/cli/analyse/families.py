"""Compute the test families of `reembody analyse`, one for each comparison of a factor's levels.

There is one family per factor, and one per level of the second factor.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from itertools import combinations
from typing import TypeVar

from app.science.statistical_tests import TESTS, Outcome, Sample
from app.science.statistics import (
    AgainstReference,
    Cells,
    Comparison,
    FloatArray,
    Friedman,
    MeanInterval,
    PageTrend,
    StatisticsError,
    TooFewData,
    against_reference,
    complete_rows,
    friedman,
    page_trend,
    pairwise,
    place_of,
)
from app.science.statistics import mean_interval as interval_of

T = TypeVar("T")
OWN_OUTPUT = frozenset({"friedman", "page_trend", "rm_anova", "against_reference"})
"""Registered tests that have their own fields in the output."""
_MOST_FACTORS = 2
_TWO = 2


@dataclass(frozen=True)
class Question:
    """A comparison of the levels of one factor, averaged over the other or at one of its levels.

    Attributes:
        averaged_over: factors that each subject's values are averaged over.
        at: the level of each other factor at which the values are compared.
    """

    factor: str
    levels: tuple[str, ...]
    averaged_over: tuple[str, ...] = ()
    at: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Family:
    """A family of tests; Holm's correction is over its pairs.

    Attributes:
        ordered: whether the levels have an order: they are numbers, or it was declared.
        page: Page's trend test, for three levels or more that have an order.
        mean_differences: of each pair, in the order of `pairs`.
        intervals: Student's, of these; None of a single person.
        planned: each level against the reference, if one was named; Holm-corrected separately.
        further: by key, the outcomes of the registry's other tests.
    """

    question: Question
    ordered: bool
    friedman: Friedman | None
    page: PageTrend | None
    pairs: tuple[Comparison, ...]
    mean_differences: tuple[float, ...]
    intervals: tuple[MeanInterval | None, ...]
    planned: AgainstReference | None
    further: dict[str, Outcome]


def families_of(
    cells: Cells,
    reference: str | None,
    ordered: frozenset[str],
    warnings: list[str],
) -> list[Family]:
    """Test each factor averaged over the other, then the first at each level of the second.

    `ordered` names the factors whose levels have an order; only along these can there be a trend.
    The reference must be a level of the first factor; otherwise StatisticsError is raised.
    """
    names = cells.factors
    if reference is not None:
        place_of(cells.levels[0], reference)
    found = []
    for axis, (factor, levels) in enumerate(zip(names, cells.levels, strict=True), start=1):
        over = tuple(name for name in names if name != factor)
        question = Question(factor, levels, averaged_over=over)
        against = reference if axis == 1 else None
        has_trend = factor in ordered
        if not has_trend and len(levels) > _TWO:
            warnings.append(
                f"{factor}: no trend test, because the levels are names without an order; declare"
                f" one with --order '{factor}={','.join(levels)}'"
            )
        values = cells.of_factor(axis)
        found.append(_family_of(question, values, against, warnings, ordered=has_trend))
    if len(names) == _MOST_FACTORS:
        for place, level in enumerate(cells.levels[1]):
            question = Question(names[0], cells.levels[0], at={names[1]: level})
            values = cells.values[:, :, place]
            has_trend = names[0] in ordered
            found.append(_family_of(question, values, reference, warnings, ordered=has_trend))
    return found


def _family_of(
    question: Question,
    values: FloatArray,
    reference: str | None,
    warnings: list[str],
    *,
    ordered: bool,
) -> Family:
    """Compute one family of tests.

    Pairwise tests use all subjects that have both levels, the other tests those that have all
    levels.
    """
    at = "".join(f" at {factor} {level}" for factor, level in question.at.items())
    where = f"{question.factor}{at}: "
    levels = question.levels
    whole, _ = complete_rows(values)
    ranked = tried(lambda: friedman(whole), warnings, where)
    if ranked is not None and ranked.note:
        warnings.append(f"{where}p of Friedman's test is {ranked.note}")
    pairs = tried(lambda: pairwise(values, levels), warnings, where) or ()
    warnings += [f"{where}{note}" for pair in pairs for note in _notes(pair)]
    # Without differences within any subject there is nothing to rank, which Friedman's test said.
    has_trend = ordered and len(levels) > _TWO and ranked is not None
    differences = [complete_rows(a - b)[0] for a, b in combinations(values.T, 2)] if pairs else []
    return Family(
        question=question,
        ordered=ordered,
        friedman=ranked,
        page=tried(lambda: page_trend(whole), warnings, where) if has_trend else None,
        pairs=pairs,
        mean_differences=tuple(float(one.mean()) for one in differences),
        intervals=tuple(mean_interval(one) for one in differences),
        planned=tried(lambda: against_reference(values, levels, reference), warnings, where)
        if reference is not None
        else None,
        further=_further(whole, levels, warnings, where),
    )


def _notes(pair: Comparison) -> list[str]:
    """Name a test that says nothing, and a W that other programs report differently."""
    test, name = pair.test, f"{pair.a} - {pair.b}"
    if test.degenerate:
        unlike = ". Friedman's and Page's tests rank the values as they are, without rounding"
        rounded = unlike if test.n_rounded else ""
        return [f"{name}: {test.degenerate}, so there is nothing to test{rounded}"]
    if not math.isclose(test.w_plus_unrounded, test.w_plus):
        other = (
            f"{name}: R's wilcox.test gives V = {test.w_plus_unrounded:g} instead of"
            f" {test.w_plus:g}, because it does not see that some differences are equal"
            " (digits.rank = 7 makes it)"
        )
        return [other]
    return []


def _further(
    whole: FloatArray, levels: tuple[str, ...], warnings: list[str], where: str
) -> dict[str, Outcome]:
    """Run every other registered test that needs no reference, and return the outcomes by key."""
    found = {}
    for test in TESTS:
        if test.key in OWN_OUTPUT or test.needs_reference or len(levels) < test.fewest_conditions:
            continue
        sample = Sample(whole, levels, test.directions[0])
        outcome = tried(partial(test.load(), sample), warnings, where)
        if outcome is not None:
            found[test.key] = outcome
    return found


def tried(compute: Callable[[], T], warnings: list[str], where: str = "") -> T | None:
    """Return the result of `compute`; if it fails, add a warning and return None."""
    try:
        return compute()
    except StatisticsError as error:
        warnings.append(f"{where}{error}")
        return None


def mean_interval(values: FloatArray) -> MeanInterval | None:
    """Return Student's interval of the mean; None for fewer than two values."""
    try:
        return interval_of(values)
    except TooFewData:
        return None
