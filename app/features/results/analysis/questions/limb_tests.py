"""What is asked of one measure and one limb: by ranks, exact where possible."""

from collections.abc import Iterator

import numpy as np

from app.features.results.analysis.questions.asked import WILCOXON_SOURCE, Asked, apa_of, listwise
from app.features.results.analysis.questions.bootstrapped import mean_words
from app.features.results.analysis.questions.floors import friedman_floor, signed_floor
from app.features.results.analysis.questions.measures import Measure
from app.features.results.analysis.questions.trends import trend
from app.features.results.analysis.questions.words import (
    Brief,
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
    StatisticsError,
    against_reference,
    friedman,
)

FRIEDMAN_SOURCE = (
    "Friedman 1937, J. Am. Stat. Assoc. 32:675; Kendall and Babington Smith 1939, Ann. Math. Stat. "
    "10:275."
)


def limb_results(measure: Measure, limb: str, alpha: float) -> Iterator[Said]:
    """Friedman, planned comparisons and the trend; what cannot be tested says why."""
    asked = Asked(measure, limb, measure.table(limb).to_numpy(dtype=np.float64), alpha)
    for test, title in (
        (_friedman, "Do the latencies differ?"),
        (_planned, f"Each latency against {measure.levels[0]} ms"),
        (trend, "Is there a trend along latency?"),
    ):
        try:
            yield test(asked)
        except StatisticsError as error:
            key = f"{test.__name__.strip('_')}_{limb}"
            heading = f"{limb.capitalize()}: {title}"
            yield Said(key, heading, f"This cannot be tested. {error}", "", (), (), "", "")


def _friedman(asked: Asked) -> Said:
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
        method=f"Friedman’s test with ties, {found.method} p. {listwise(asked)} {found.note}",
        source=FRIEDMAN_SOURCE,
        warnings=(
            friedman_floor(found, asked.alpha),
            measured(f"friedman_{found.method}"),
        ),
        brief=Brief(f"{p_words(found.p)}, W = {bounded(found.kendall_w, 2)}"),
    )


def _planned(asked: Asked) -> Said:
    levels = asked.measure.levels
    found = against_reference(asked.table, levels, levels[0], alpha=asked.alpha)
    first = found.first_that_differs
    told = (
        f"The first latency that differs from {levels[0]} ms is {first} ms,"
        if first
        else f"No latency differs from {levels[0]} ms"
    )
    parts, floor = [apa_of(one) for one in found.comparisons], signed_floor(found)
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
        warnings=(floor, measured("wilcoxon_holm")),
        brief=None if floor else Brief(f"{first} ms" if first else ""),
    )


def _row(asked: Asked, one: Comparison) -> tuple[str, ...]:
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
