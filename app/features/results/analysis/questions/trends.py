"""Whether a measure goes one way along latency: Page's test, one-sided where it was predicted."""

from app.features.results.analysis.questions.asked import WILCOXON_SOURCE, Asked, apa_of, listwise
from app.features.results.analysis.questions.floors import signed_floor
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
    Direction,
    DirectionalHypothesis,
    PageTrend,
    directional,
    page_trend,
)

PAGE_SOURCE = "Page 1963, J. Am. Stat. Assoc. 58:216."


def trend(asked: Asked) -> Said:
    """One-sided where a direction was predicted, else doubled; raises StatisticsError."""
    predicted, levels = asked.measure.predicted, asked.measure.levels
    if predicted is None:
        return _open(asked, page_trend(asked.complete))
    return _predicted(asked, directional(asked.table, levels, predicted, alpha=asked.alpha))


def _open(asked: Asked, found: PageTrend) -> Said:
    p, way = min(1.0, 2.0 * min(found.p, found.p_falling)), _way(found)
    cells = (number(found.statistic, 1), p_cell(found.p), p_cell(found.p_falling), p_cell(p))
    return Said(
        key=f"trend_{asked.limb}",
        title=f"{asked.limb.capitalize()}: Is there a trend along latency?",
        sentence=(
            f"No direction was predicted, so Page’s test is doubled: {against(p, asked.alpha)}. "
            f"By ranks the measure {way or 'goes neither way'} with latency."
        ),
        apa=(
            f"{asked.name}: Page’s L = {number(found.statistic, 1)}, N = {found.n}, two-sided "
            f"{p_words(p)} ({found.method})"
        ),
        columns=("L", "p (rises)", "p (falls)", "p (two-sided)", "n"),
        rows=[(*cells, str(found.n))],
        method=f"Page’s trend test, {found.method}, doubled one-sided p. {listwise(asked)}",
        source=PAGE_SOURCE,
        warnings=(measured("page"),),
        exploratory=True,
        brief=Brief(p_words(p), way),
    )


def _way(found: PageTrend) -> Direction | None:
    if found.p == found.p_falling:
        return None
    return "rises" if found.p < found.p_falling else "falls"


def _predicted(asked: Asked, found: DirectionalHypothesis) -> Said:
    support = "supported" if found.supported else "not supported"
    parts = [apa_of(one) for one in found.against_first.comparisons]
    return Said(
        key=f"trend_{asked.limb}",
        title=f"{asked.limb.capitalize()}: It was predicted that it {found.predicted} with latency",
        sentence=(
            f"The prediction is {support}: one-sided {against(found.p, asked.alpha)} (Page’s "
            f"test, n = {found.trend.n}). The other direction would be no support, whatever its "
            "size."
        ),
        apa=(
            f"{asked.name}, predicted to {found.predicted[:-1]}: Page’s L = "
            f"{number(found.trend.statistic, 1)}, N = {found.trend.n}, one-sided "
            f"{p_words(found.p)}; {'; '.join(parts)}"
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
            f"against {asked.measure.levels[0]} ms with Holm’s rule. {listwise(asked)}"
        ),
        source=f"{PAGE_SOURCE} {WILCOXON_SOURCE} Direction: Waltemate et al. 2016.",
        warnings=(signed_floor(found.against_first), measured("page_given_ties")),
        brief=Brief(p_words(found.p), _way(found.trend)),
    )
