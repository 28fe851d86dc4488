"""The rank tests of one measure and one limb, exact where possible.

They test whether latencies differ (Friedman), which differ from the smallest (Wilcoxon, Holm), and
whether the measure rises or falls with latency (Page, one-sided where a direction was predicted).
Bodies have no order: of these, all pairs are compared, and there is no trend.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from app.features.results.analysis.questions.measures import LATENCY_FACTOR, Factor, Measure
from app.features.results.analysis.questions.words import (
    NONE,
    Brief,
    TestReport,
    against,
    bounded,
    error_rate_warning,
    mean_words,
    number,
    p_cell,
    p_words,
)
from app.science.statistical_tests import TESTS, Sample, StatisticalTest, statistical_test
from app.science.statistics import (
    AgainstReference,
    Comparison,
    Direction,
    DirectionalHypothesis,
    FloatArray,
    Friedman,
    PageTrend,
    StatisticsError,
    against_reference,
    complete_rows,
    directional,
    friedman,
    page_trend,
    pairwise,
)

_PAIR = 2
WILCOXON, PAGE = statistical_test("against_reference"), statistical_test("page_trend")
FRIEDMAN = statistical_test("friedman")
REPORTED = frozenset({"friedman", "page_trend", "against_reference", "rm_anova"})
"""Tests with a report of their own; that of the analysis of variance is in `models`."""


@dataclass(frozen=True, eq=False)
class LimbData:
    """The data of one measure for one limb, with the alpha to test at.

    `table`: (n, L) participants x levels of the factor, NaN where there is no value.
    """

    measure: Measure
    limb: str
    table: FloatArray
    alpha: float

    @property
    def complete(self) -> FloatArray:
        """Return the rows of the participants with a value at every level."""
        return complete_rows(self.table)[0]

    @property
    def name(self) -> str:
        """Return the name of the measure and task as a paper would print it."""
        return f"{self.measure.title}, {self.limb} task"


def apa_of(one: Comparison, factor: Factor = LATENCY_FACTOR) -> str:
    """Return a comparison as one line for a paper."""
    if one.test.degenerate:
        return f"{one.a} vs. {factor.words(one.b)}: not tested, {one.test.degenerate}"
    return (
        f"{one.a} vs. {factor.words(one.b)}: W = {number(one.test.w, 1)}, n = {one.test.n}, "
        f"{p_words(one.test.p)}, Holm-adjusted {p_words(one.p_holm)}, rank-biserial r = "
        f"{bounded(one.test.rank_biserial, 2)}"
    )


def signed_cells(one: Comparison) -> tuple[str, str, str, str]:
    """Return W, p, adjusted p and effect size; dashes where there is nothing to test."""
    if one.test.degenerate:
        return NONE, NONE, NONE, NONE
    return (
        number(one.test.w, 1),
        p_cell(one.test.p),
        p_cell(one.p_holm),
        bounded(one.test.rank_biserial, 2),
    )


def listwise(data: LimbData) -> str:
    """Return a sentence on how many participants lack a level, empty if none does."""
    left, name = len(data.table) - len(data.complete), data.measure.factor.name
    return f"{left} participants who did not complete every {name} are left out." if left else ""


def signed_floor(found: AgainstReference) -> str:
    """Return a warning if no outcome of the signed-rank tests could be significant, and why.

    There are too few participants, or too many of them have equal values: these are left out.
    """
    sides = 1.0 if found.alternative != "two-sided" else 2.0
    return _signed_floor(found.comparisons, sides, found.alpha)


def _signed_floor(comparisons: Sequence[Comparison], sides: float, alpha: float) -> str:
    family = len(comparisons)
    most = max((one.test.n - one.test.n_zero for one in comparisons), default=0)
    floor = min(1.0, sides * family * 0.5**most)
    if floor <= alpha:
        return ""
    n = max((one.test.n for one in comparisons), default=0)
    if not most:
        return f"No result is possible: {n} participants have equal values in all comparisons."
    if sides * family * 0.5**n > alpha:
        return (
            f"Too few participants for any result: with {most} differences other than zero and "
            f"{family} comparisons the smallest possible adjusted p is {bounded(floor)}, above α = "
            f"{bounded(alpha, 2)}."
        )
    return (
        f"Too many equal values for any result: of {n} participants at most {most} have a "
        f"difference other than zero, so that with {family} comparisons the smallest possible "
        f"adjusted p is {bounded(floor)}, above α = {bounded(alpha, 2)}."
    )


def friedman_floor(found: Friedman, alpha: float) -> str:
    """Return a warning if n is too small for Friedman's test to reach significance.

    Its smallest exact p is k!^(1 - n).
    """
    floor = float(math.factorial(found.df + 1)) ** (1 - found.n)
    if floor <= alpha:
        return ""
    return (
        f"Too few participants for any result: with {found.n} the smallest possible exact p is "
        f"{bounded(floor)}, above α = {bounded(alpha, 2)}."
    )


def trend(data: LimbData) -> TestReport:
    """Report Page's trend test, one-sided where a direction was predicted, else doubled.

    Raises StatisticsError if the test cannot be computed.
    """
    predicted, levels = data.measure.predicted, data.measure.levels
    if predicted is None:
        return _two_sided_trend(data, page_trend(data.complete))
    return _predicted_trend(data, directional(data.table, levels, predicted, alpha=data.alpha))


def _two_sided_trend(data: LimbData, found: PageTrend) -> TestReport:
    p, way = min(1.0, 2.0 * min(found.p_rises, found.p_falls)), _direction(found)
    cells = (number(found.statistic, 1), p_cell(found.p_rises), p_cell(found.p_falls), p_cell(p))
    method = "exact given the ties" if found.method == "exact" else found.method
    return TestReport(
        key=f"trend_{data.limb}",
        title=f"{data.limb.capitalize()}: Is there a trend along latency?",
        sentence=(
            f"No direction was predicted, so Page’s test is doubled: {against(p, data.alpha)}. "
            f"By ranks the measure {way or 'neither rises nor falls'} with latency."
        ),
        apa=(
            f"{data.name}: Page’s L = {number(found.statistic, 1)}, N = {found.n}, two-sided "
            f"{p_words(p)} ({method})"
        ),
        columns=("L", "p (rises)", "p (falls)", "p (two-sided)", "n"),
        rows=[(*cells, str(found.n))],
        method=f"Page’s trend test, {method}, doubled one-sided p. {listwise(data)}",
        source=PAGE.source,
        warnings=(error_rate_warning("page_given_ties"),),
        exploratory=True,
        brief=Brief(p_words(p), way),
    )


def _direction(found: PageTrend) -> Direction | None:
    if math.isclose(found.p_rises, found.p_falls):
        return None
    return "rises" if found.p_rises < found.p_falls else "falls"


def _predicted_trend(data: LimbData, found: DirectionalHypothesis) -> TestReport:
    support = "supported" if found.supported else "not supported"
    parts = [apa_of(one) for one in found.against_first.comparisons]
    return TestReport(
        key=f"trend_{data.limb}",
        title=f"{data.limb.capitalize()}: It was predicted that it {found.predicted} with latency",
        sentence=(
            f"The prediction is {support}: one-sided {against(found.p, data.alpha)} (Page’s "
            f"test, n = {found.trend.n}). The other direction would be no support, whatever its "
            "size."
        ),
        apa=(
            f"{data.name}, predicted to {found.predicted[:-1]}: Page’s L = "
            f"{number(found.trend.statistic, 1)}, N = {found.trend.n}, one-sided "
            f"{p_words(found.p)}; {'; '.join(parts)}"
        ),
        columns=("latency (ms)", "n", "W", "p (one-sided)", "p (Holm)", "rank-biserial"),
        rows=[
            (
                one.a,
                str(one.test.n),
                *signed_cells(one),
            )
            for one in found.against_first.comparisons
        ],
        method=(
            "Page’s trend test, one-sided, exact given the ties, then one-sided signed-rank tests "
            f"against {data.measure.levels[0]} ms with Holm’s rule. {listwise(data)}"
        ),
        source=f"{PAGE.source} {WILCOXON.source} Direction: Waltemate et al. 2016.",
        warnings=(signed_floor(found.against_first), error_rate_warning("page_given_ties")),
        brief=Brief(p_words(found.p), _direction(found.trend)),
    )


def limb_results(measure: Measure, limb: str, alpha: float) -> Iterator[TestReport]:
    """Yield Friedman's test, planned comparisons, the trend and every further registered test.

    A test that cannot be computed is reported with the reason.
    """
    data = LimbData(measure, limb, measure.table(limb).to_numpy(dtype=np.float64), alpha)
    for report, key, title in _reports_of(measure):
        try:
            yield report(data)
        except StatisticsError as error:
            heading = f"{limb.capitalize()}: {title}"
            yield TestReport(
                f"{key}_{limb}", heading, f"This cannot be tested. {error}", "", (), (), "", ""
            )


def _reports_of(measure: Measure) -> list[tuple[Callable[[LimbData], TestReport], str, str]]:
    """Return what is reported of a limb, with the key and the title of each report."""
    levels, factor = measure.levels, measure.factor
    differ = (_friedman, "friedman", _differ(measure))
    if factor.order is None:
        return [
            differ,
            (_planned, "planned", f"Each latency against {levels[0]} ms"),
            (trend, "trend", PAGE.question),
            *((partial(_further, one), one.key, one.question) for one in further_tests()),
        ]
    further = [
        one
        for one in further_tests()
        if "two_sided" in one.directions and len(levels) >= one.fewest_conditions
    ]
    return [
        *([differ] if len(levels) >= FRIEDMAN.fewest_conditions else []),
        (_pairs, "pairs", f"Every pair of {factor.plural}"),
        *((partial(_further, one), one.key, one.question) for one in further),
    ]


def _differ(measure: Measure) -> str:
    return f"Do the {measure.factor.plural} differ?"


def further_tests() -> list[StatisticalTest]:
    """Return the registered tests that have no report of their own, here or in `models`."""
    return [one for one in TESTS if one.key not in REPORTED]


def _further(test: StatisticalTest, data: LimbData) -> TestReport:
    """Report a test that has no report of its own; it is exploratory."""
    sample = Sample(data.complete, data.measure.levels, test.directions[0], alpha=data.alpha)
    found = test.load()(sample)
    return TestReport(
        key=f"{test.key}_{data.limb}",
        title=f"{data.limb.capitalize()}: {test.question}",
        sentence=f"With {found.n} participants {against(found.p, data.alpha)} ({test.phrase}).",
        apa=f"{data.name}, {test.phrase}: {found.sentence}",
        columns=found.columns,
        rows=found.rows,
        method=f"{found.method} {listwise(data)}",
        source=test.source,
        exploratory=True,
        brief=Brief(p_words(found.p)),
    )


def _friedman(data: LimbData) -> TestReport:
    found = friedman(data.complete)
    differ = "differ" if found.p <= data.alpha else "are not shown to differ"
    levels, factor = data.measure.levels, data.measure.factor
    apa = (
        f"{data.name}: Friedman χ²({found.df}, N = {found.n}) = {number(found.statistic)}, "
        f"{p_words(found.p)} ({found.method}), Kendall’s W = {bounded(found.kendall_w, 2)}"
    )
    return TestReport(
        key=f"friedman_{data.limb}",
        title=f"{data.limb.capitalize()}: {_differ(data.measure)}",
        sentence=(
            f"With {found.n} participants the {factor.plural} {differ}: "
            f"{against(found.p, data.alpha)}; Kendall’s W = {bounded(found.kendall_w, 2)} "
            f"(0: participants disagree, 1: all rank the {factor.plural} in the same order)."
        ),
        apa=apa,
        columns=(factor.heading, "mean rank"),
        rows=[(at, number(rank)) for at, rank in zip(levels, found.mean_ranks, strict=True)],
        method=f"Friedman’s test with ties, {found.method} p. {listwise(data)} {found.note}",
        source=FRIEDMAN.source,
        warnings=(
            friedman_floor(found, data.alpha),
            error_rate_warning(f"friedman_{found.method}"),
        ),
        brief=Brief(f"{p_words(found.p)}, W = {bounded(found.kendall_w, 2)}"),
    )


def _planned(data: LimbData) -> TestReport:
    levels = data.measure.levels
    found = against_reference(data.table, levels, levels[0], alpha=data.alpha)
    first = found.first_that_differs
    first_difference = (
        f"The first latency that differs from {levels[0]} ms is {first} ms,"
        if first
        else f"No latency differs from {levels[0]} ms"
    )
    parts, floor = [apa_of(one) for one in found.comparisons], signed_floor(found)
    return TestReport(
        key=f"planned_{data.limb}",
        title=f"{data.limb.capitalize()}: Each latency against {levels[0]} ms",
        sentence=(
            f"{first_difference} at α = {bounded(data.alpha, 2)} over all {len(found.comparisons)} "
            "comparisons. "
            + (
                "This is not a threshold: latencies between those tested are unknown."
                if first
                else ""
            )
        ),
        apa=f"{data.name}: {'; '.join(parts)}",
        columns=_columns(data, "latency (ms)"),
        rows=[_row(data, one) for one in found.comparisons],
        method=(
            "Wilcoxon’s signed-rank tests, two-sided, exact given the ties, differences of zero "
            f"left out; Holm’s rule over {len(found.comparisons)} comparisons; pairs with a "
            "missing value are left out of their comparison. Positive: larger than at "
            f"{levels[0]} ms. {error_rate_warning('student_mean')}"
        ),
        source=WILCOXON.source,
        warnings=(floor, error_rate_warning("wilcoxon_holm")),
        brief=None if floor else Brief(f"{first} ms" if first else ""),
    )


def _pairs(data: LimbData) -> TestReport:
    """Report the exact signed-rank test of every pair of levels that have no order."""
    levels, factor = data.measure.levels, data.measure.factor
    found = pairwise(data.table, levels)
    differing = [
        f"{one.a} and {one.b}"
        for one in found
        if not one.test.degenerate and one.p_holm <= data.alpha
    ]
    verdict = f"{'; '.join(differing)} differ" if differing else f"No two {factor.plural} differ"
    floor = _signed_floor(found, 2.0, data.alpha)
    brief = "" if not differing else "; ".join(differing)
    if len(levels) == _PAIR and not found[0].test.degenerate:
        brief = p_words(found[0].p_holm)
    return TestReport(
        key=f"pairs_{data.limb}",
        title=f"{data.limb.capitalize()}: Every pair of {factor.plural}",
        sentence=(
            f"{verdict} at α = {bounded(data.alpha, 2)} over all {len(found)} comparisons."
            if len(found) > 1
            else f"{verdict} at α = {bounded(data.alpha, 2)}."
        ),
        apa=f"{data.name}: {'; '.join(apa_of(one, factor) for one in found)}",
        columns=_columns(data, factor.plural),
        rows=[(f"{one.a} − {one.b}", *_row(data, one)[1:]) for one in found],
        method=(
            "Wilcoxon’s signed-rank tests, two-sided, exact given the ties, differences of zero "
            f"left out; Holm’s rule over {len(found)} comparisons; participants without one of "
            f"the two are left out of a comparison. {error_rate_warning('student_mean')}"
        ),
        source=WILCOXON.source,
        warnings=(floor, error_rate_warning("wilcoxon_holm")),
        exploratory=True,
        brief=None if floor else Brief(brief),
    )


def _columns(data: LimbData, compared: str) -> tuple[str, ...]:
    """Return the columns of a table of comparisons, the first with what is compared."""
    medians = f"Δ median ({data.measure.unit})"
    return compared, "n", medians, "Δ mean [95 % CI]", "W", "p", "p (Holm)", "rank-biserial"


def _row(data: LimbData, one: Comparison) -> tuple[str, ...]:
    levels = data.measure.levels
    column = data.table[:, levels.index(one.a)] - data.table[:, levels.index(one.b)]
    differences = column[np.isfinite(column)]
    return (
        one.a,
        str(one.test.n),
        number(one.median_difference),
        mean_words(differences),
        *signed_cells(one),
    )
