"""Run the declarable tests on complete values and report them in the style of a paper.

The computations are those of `app.science.statistics`; this module selects which of their results a
declared test reports, and formats them. Loads numpy and scipy.
"""

import math
from collections.abc import Sequence
from typing import Literal

import numpy as np

from app.science.statistical_tests.sample import Direction, Outcome, Sample
from app.science.statistics import (
    ConstantData,
    against_reference,
    friedman,
    page_trend,
    rm_anova,
)

_ALTERNATIVES: dict[Direction, Literal["two-sided", "greater", "less"]] = {
    "two_sided": "two-sided",
    "rises": "greater",
    "falls": "less",
}


def friedman_outcome(sample: Sample) -> Outcome:
    """Run Friedman's test; raises StatisticsError."""
    found = friedman(sample.values)
    return Outcome(
        n=found.n,
        p=found.p,
        sentence=f"χ²({found.df}) = {found.statistic:.2f}, {p_words(found.p)}, "
        f"W = {found.kendall_w:.3f}, n = {found.n}",
        columns=("condition", "mean rank"),
        rows=by_level(sample, found.mean_ranks),
        method=f"Friedman's test, {found.method}. {found.note}".strip(),
    )


def page_outcome(sample: Sample) -> Outcome:
    """Run Page's trend test, one-sided in the declared direction; raises StatisticsError.

    L is that of the levels in their own order, whatever the direction, as everywhere else.
    """
    found = page_trend(sample.values)
    p = found.p_falls if sample.direction == "falls" else found.p_rises
    is_exact = math.isfinite(found.p_given_ties)
    return Outcome(
        n=found.n,
        p=p,
        sentence=f"L = {found.statistic:g}, {p_words(p)}, one-sided ({sample.direction}), "
        f"n = {found.n}",
        columns=("condition", "median"),
        rows=by_level(sample, np.median(sample.values, axis=0).tolist()),
        method=(
            "Page's trend test, L of the conditions in ascending order; "
            + ("p by permutation of these ranks, ties included." if is_exact else "asymptotic p.")
        ),
    )


def anova_outcome(sample: Sample) -> Outcome:
    """Run an analysis of variance with repeated measures; raises StatisticsError."""
    whole = rm_anova(sample.values, ("latency",))
    effect = whole.effects[0]
    return Outcome(
        n=whole.n,
        p=effect.p_gg,
        sentence=f"F({effect.df * effect.epsilon:.2f}, {effect.df_error * effect.epsilon:.2f}) = "
        f"{effect.f:.2f}, {p_words(effect.p_gg)}, generalised η² = "
        f"{effect.generalised_eta_squared:.3f}, n = {whole.n}",
        columns=("condition", "mean"),
        rows=by_level(sample, sample.values.mean(axis=0).tolist()),
        method="Analysis of variance with repeated measures, Greenhouse-Geisser.",
    )


def reference_outcome(sample: Sample) -> Outcome:
    """Run signed-rank tests of every level against the reference.

    Raises ConstantData if none of them can say anything, other errors of statistics for data that
    cannot be tested at all.
    """
    alternative = _ALTERNATIVES[sample.direction]
    found = against_reference(
        sample.values,
        sample.levels,
        sample.reference or sample.levels[0],
        alternative=alternative,
        alpha=sample.alpha,
    )
    untested = [
        f"{pair.a} – {pair.b} was not tested: {pair.test.degenerate}."
        for pair in found.comparisons
        if pair.test.degenerate
    ]
    if len(untested) == len(found.comparisons):
        raise ConstantData(f"There is nothing to test. {' '.join(untested)}")
    p_values = [pair.p_holm if sample.holm else pair.test.p for pair in found.comparisons]
    lowest = min(
        p for pair, p in zip(found.comparisons, p_values, strict=True) if not pair.test.degenerate
    )
    left_out = f" ({len(untested)} not tested)" if untested else ""
    return Outcome(
        n=len(sample.values),
        p=lowest,
        sentence=f"smallest {p_words(lowest)} of {len(p_values)} comparisons with "
        f"{found.reference}{left_out}, {alternative}, n = {len(sample.values)}",
        columns=("comparison", "n", "median difference", "r (rank-biserial)", "p", "p declared"),
        rows=[
            (
                f"{pair.a} – {pair.b}",
                str(pair.test.n),
                two_decimals(pair.median_difference),
                *(
                    ("–", "–", "–")
                    if pair.test.degenerate
                    else (two_decimals(pair.test.rank_biserial), f"{pair.test.p:.3f}", f"{p:.3f}")
                ),
            )
            for pair, p in zip(found.comparisons, p_values, strict=True)
        ],
        method="Exact Wilcoxon signed-rank tests"
        + (", p adjusted by Holm's rule." if sample.holm else ", p not adjusted.")
        + "".join(f" {one}" for one in untested),
    )


def by_level(sample: Sample, figures: Sequence[float]) -> list[tuple[str, str]]:
    """Return a table row for each level, with its value."""
    return [
        (level, two_decimals(figure)) for level, figure in zip(sample.levels, figures, strict=True)
    ]


def two_decimals(value: float) -> str:
    """Format a number with two decimals and a typographic minus sign."""
    return f"{value:.2f}".replace("-", "\u2212")


def p_words(p: float) -> str:
    """Format a p value for a sentence: "p = .012" or "p < .001"."""
    return "p < .001" if p < 0.001 else f"p = {p:.3f}".replace("0.", ".", 1)
