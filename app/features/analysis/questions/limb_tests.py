"""What is asked of one measure and one limb: by ranks, exact where possible."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from app.features.analysis.questions.bootstrapped import mean_words
from app.features.analysis.questions.floors import friedman_floor, signed_floor
from app.features.analysis.questions.measures import Measure
from app.features.analysis.questions.words import (
    Said,
    against,
    bounded,
    measured,
    number,
    p_cell,
    p_words,
)
from app.science.statistics import (
    Comparison,
    DirectionalHypothesis,
    StatisticsError,
    against_reference,
    directional,
    friedman,
    page_trend,
)
from app.science.statistics.arrays import FloatArray, complete_rows

FRIEDMAN_SOURCE = (
    "Friedman 1937, J. Am. Stat. Assoc. 32:675; Kendall and Babington Smith 1939, Ann. Math. Stat. "
    "10:275."
)
WILCOXON_SOURCE = (
    "Wilcoxon 1945, Biometrics Bull. 1:80; Holm 1979, Scand. J. Stat. 6:65; Kerby 2014, Compr. "
    "Psychol. 3:1; Efron 1987, J. Am. Stat. Assoc. 82:171."
)
PAGE_SOURCE = "Page 1963, J. Am. Stat. Assoc. 58:216."


@dataclass(frozen=True, eq=False)
class _Asked:
    """One measure at one limb: participants x latencies."""

    measure: Measure
    limb: str
    table: FloatArray
    alpha: float

    @property
    def complete(self) -> FloatArray:
        return complete_rows(self.table)[0]

    @property
    def name(self) -> str:
        return f"{self.measure.title}, {self.limb} task"


def limb_results(measure: Measure, limb: str, alpha: float) -> Iterator[Said]:
    """Friedman, planned comparisons and the trend; what cannot be tested says why."""
    asked = _Asked(measure, limb, measure.table(limb).to_numpy(dtype=np.float64), alpha)
    for test, title in (
        (_friedman, "Do the latencies differ?"),
        (_planned, f"Each latency against {measure.levels[0]} ms"),
        (_trend, "Is there a trend along latency?"),
    ):
        try:
            yield test(asked)
        except StatisticsError as error:
            key = f"{test.__name__.strip('_')}_{limb}"
            heading = f"{limb.capitalize()}: {title}"
            yield Said(key, heading, f"This cannot be tested. {error}", "", (), (), "", "")


def _friedman(asked: _Asked) -> Said:
    found = friedman(asked.complete)
    differ = "differ" if found.p <= asked.alpha else "are not told apart"
    levels = asked.measure.levels
    apa = (
        f"{asked.name}: Friedman χ²({found.df}, N = {found.n}) = {number(found.statistic)}, "
        f"{p_words(found.p)} ({found.method}), Kendall’s W = {bounded(found.kendall_w, 2)}"
    )
    return Said(
        key=f"friedman_{asked.limb}",
        title=f"{asked.limb.capitalize()}: Do the latencies differ?",
        sentence=(
            f"With {found.n} participants the latencies {differ}: {against(found.p, asked.alpha)}; "
            f"Kendall’s W = {bounded(found.kendall_w, 2)} (0: participants disagree, 1: all order "
            "the latencies alike)."
        ),
        apa=apa,
        columns=("latency (ms)", "mean rank"),
        rows=[(at, number(rank)) for at, rank in zip(levels, found.mean_ranks, strict=True)],
        method=f"Friedman’s test with ties, {found.method} p. {_listwise(asked)} {found.note}",
        source=FRIEDMAN_SOURCE,
        warnings=(
            friedman_floor(found, asked.alpha),
            measured(f"friedman_{found.method}"),
        ),
    )


def _planned(asked: _Asked) -> Said:
    levels = asked.measure.levels
    found = against_reference(asked.table, levels, levels[0], alpha=asked.alpha)
    first = found.first_that_differs
    told = (
        f"The first latency that differs from {levels[0]} ms is {first} ms,"
        if first
        else f"No latency differs from {levels[0]} ms"
    )
    parts = [_apa_of(one) for one in found.comparisons]
    return Said(
        key=f"planned_{asked.limb}",
        title=f"{asked.limb.capitalize()}: Each latency against {levels[0]} ms",
        sentence=(
            f"{told} at α = {bounded(asked.alpha, 2)} over all {len(found.comparisons)} "
            "comparisons. "
            + ("It is no threshold: latencies between those tested are unknown." if first else "")
        ),
        apa=f"{asked.name}: {'; '.join(parts)}",
        columns=(
            "latency (ms)",
            "n",
            f"Δ median ({asked.measure.unit})",
            "Δ mean [95 % BCa CI]",
            "W",
            "p",
            "p (Holm)",
            "rank-biserial",
        ),
        rows=[_row(asked, one) for one in found.comparisons],
        method=(
            "Wilcoxon’s signed-rank tests, two-sided, exact given the ties, differences of zero "
            f"left out; Holm’s rule over {len(found.comparisons)} comparisons; pairs with a "
            "missing value are left out of their comparison. Positive: larger than at "
            f"{levels[0]} ms. {measured('bca_mean')}"
        ),
        source=WILCOXON_SOURCE,
        warnings=(signed_floor(found), measured("wilcoxon_holm")),
    )


def _row(asked: _Asked, one: Comparison) -> tuple[str, ...]:
    levels = asked.measure.levels
    column = asked.table[:, levels.index(one.a)] - asked.table[:, levels.index(one.b)]
    differences = column[np.isfinite(column)]
    return (
        one.a,
        str(one.test.n),
        number(one.median_difference),
        mean_words(differences),
        number(one.test.w, 1),
        p_cell(one.test.p),
        p_cell(one.p_holm),
        bounded(one.test.rank_biserial, 2),
    )


def _apa_of(one: Comparison) -> str:
    return (
        f"{one.a} vs. {one.b} ms: W = {number(one.test.w, 1)}, n = {one.test.n}, "
        f"{p_words(one.test.p)}, Holm-adjusted {p_words(one.p_holm)}, rank-biserial r = "
        f"{bounded(one.test.rank_biserial, 2)}"
    )


def _trend(asked: _Asked) -> Said:
    if asked.measure.predicted is not None:
        return _predicted(
            asked,
            directional(
                asked.table, asked.measure.levels, asked.measure.predicted, alpha=asked.alpha
            ),
        )
    found = page_trend(asked.complete)
    p = min(1.0, 2.0 * min(found.p, found.p_falling))
    way = "rises" if found.p < found.p_falling else "falls"
    return Said(
        key=f"trend_{asked.limb}",
        title=f"{asked.limb.capitalize()}: Is there a trend along latency?",
        sentence=(
            f"No direction was predicted, so Page’s test is doubled: {against(p, asked.alpha)}. "
            f"By ranks the measure {way} with latency."
        ),
        apa=(
            f"{asked.name}: Page’s L = {number(found.statistic, 1)}, N = {found.n}, two-sided "
            f"{p_words(p)} ({found.method})"
        ),
        columns=("L", "p (rises)", "p (falls)", "p (two-sided)", "n"),
        rows=[
            (
                number(found.statistic, 1),
                p_cell(found.p),
                p_cell(found.p_falling),
                p_cell(p),
                str(found.n),
            )
        ],
        method=f"Page’s trend test, {found.method}, doubled one-sided p. {_listwise(asked)}",
        source=PAGE_SOURCE,
        warnings=(measured("page"),),
        exploratory=True,
    )


def _predicted(asked: _Asked, found: DirectionalHypothesis) -> Said:
    support = "supported" if found.supported else "not supported"
    parts = [_apa_of(one) for one in found.against_first.comparisons]
    return Said(
        key=f"trend_{asked.limb}",
        title=f"{asked.limb.capitalize()}: It was predicted that it {found.predicted} with latency",
        sentence=(
            f"The prediction is {support}: one-sided {against(found.p, asked.alpha)} (Page’s "
            f"test, n = {found.trend.n}). The other direction would be no support, whatever its "
            "size."
        ),
        apa=(
            f"{asked.name}, predicted to fall: Page’s L = {number(found.trend.statistic, 1)}, N = "
            f"{found.trend.n}, one-sided {p_words(found.p)}; {'; '.join(parts)}"
        ),
        columns=("latency (ms)", "n", "W", "p (one-sided)", "p (Holm)", "rank-biserial"),
        rows=[
            (
                one.a,
                str(one.test.n),
                number(one.test.w, 1),
                p_cell(one.test.p),
                p_cell(one.p_holm),
                bounded(one.test.rank_biserial, 2),
            )
            for one in found.against_first.comparisons
        ],
        method=(
            "Page’s trend test, one-sided, exact given the ties, then one-sided signed-rank tests "
            f"against {asked.measure.levels[0]} ms with Holm’s rule. {_listwise(asked)}"
        ),
        source=f"{PAGE_SOURCE} {WILCOXON_SOURCE} Direction: Waltemate et al. 2016.",
        warnings=(signed_floor(found.against_first), measured("page_given_ties")),
    )


def _listwise(asked: _Asked) -> str:
    left = len(asked.table) - len(asked.complete)
    return f"{left} participants without every latency are left out." if left else ""
