"""Compute every test and interval that the product offers on one data set without effects.

A test's outcome is whether it rejects at 5 %, an interval's whether it contains the truth. The
outcome is None if it could not be computed (no variance, a model that did not converge).
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np

from app.science.statistics import (
    LEVEL,
    Kind,
    aligned_contrasts,
    aligned_ranks_within,
    bootstrap_interval,
    cronbach_alpha,
    friedman,
    mean_interval,
    mean_of,
    median_of,
    page_trend,
    pairwise,
    rm_anova,
)
from app.science.statistics.mixed import (
    build_design,
    carry_over,
    contrasts,
    covariate,
    cumulative_term_tests,
    factor,
    fit_mixed_model,
    term_test,
)
from tests.benchmarks.null_data import LATENCIES_MS, LIMBS, NullData

Outcomes = Iterator[tuple[str, bool | None]]
NAMES = tuple(str(one) for one in LATENCIES_MS)
FACTORS = ("latency", "limb")
BOTH = "latency:limb"


@dataclass(frozen=True)
class About:
    """The description of a test: its data, its printed name, its kind, and whether it is exact."""

    measure: str
    title: str
    kind: Kind = "rejection"
    exact: bool = False


ABOUT = {
    "friedman_exact": About("item", "Friedman, exact (up to 15 participants)", exact=True),
    "friedman_asymptotic": About("item", "Friedman, chi-square"),
    "wilcoxon_exact": About("item", "Wilcoxon signed-rank, exact, 350 against 0 ms", exact=True),
    "wilcoxon_asymptotic": About("item", "Wilcoxon signed-rank, normal, 350 against 0 ms"),
    "wilcoxon_holm": About("item", "Wilcoxon, exact, any of three pairs after Holm", exact=True),
    "page": About("item", "Page's trend, by the tables without ties"),
    "page_given_ties": About("item", "Page's trend, exact given the ties", exact=True),
    "page_asymptotic": About("item", "Page's trend, normal"),
    "rm_anova_gg": About("measure", "rm ANOVA, latency, Greenhouse-Geisser"),
    "rm_anova_gg_interaction": About("measure", "rm ANOVA, latency x limb, Greenhouse-Geisser"),
    "rm_anova_item": About("item", "rm ANOVA on an item, latency, Greenhouse-Geisser"),
    "art": About("item", "Aligned ranks, latency"),
    "art_interaction": About("item", "Aligned ranks, latency x limb"),
    "art_c_holm": About("item", "ART-C, any of three pairs after Holm"),
    "mixed_model": About("measure", "Mixed model, latency, random intercepts"),
    "mixed_model_interaction": About("measure", "Mixed model, latency x limb, random intercepts"),
    "mixed_model_holm": About("measure", "Mixed model, any of three pairs after Holm"),
    "mixed_model_slope": About("measure", "Mixed model, latency, random intercepts and slopes"),
    "carry_over": About("measure", "First-order carry-over"),
    "period": About("measure", "Period"),
    "sequence": About("measure", "Sequence"),
    "clmm_laplace": About("item", "Cumulative link mixed model, latency, likelihood ratio"),
    "alpha_interval": About("scale", "Cronbach's alpha, Feldt's interval", "coverage"),
    "student_mean": About("measure", "Mean difference, Student's interval", "coverage"),
    "bca_mean": About("measure", "Mean difference, BCa bootstrap", "coverage"),
    "bca_median": About("measure", "Median difference, BCa bootstrap", "coverage"),
}


def ranks(data: NullData, alpha: float, rng: np.random.Generator) -> Outcomes:
    """Run Friedman, Wilcoxon and Page tests on the hand's item."""
    blocks = data.item[:, :, 0].astype(np.float64)
    found = friedman(blocks)
    if found.method == "exact":
        yield "friedman_exact", found.p <= LEVEL
    yield "friedman_asymptotic", found.p_asymptotic <= LEVEL
    compared = pairwise(blocks, NAMES)
    yield "wilcoxon_holm", any(one.p_holm <= LEVEL for one in compared)
    (widest,) = (one for one in compared if (one.a, one.b) == ("0", "350"))
    yield "wilcoxon_exact", widest.test.p <= LEVEL
    yield "wilcoxon_asymptotic", widest.test.p_asymptotic <= LEVEL
    trend = page_trend(blocks)
    yield "page", trend.p <= LEVEL
    yield "page_given_ties", trend.p_given_ties <= LEVEL
    yield "page_asymptotic", trend.p_asymptotic <= LEVEL


def means(data: NullData, alpha: float, rng: np.random.Generator) -> Outcomes:
    """Run an analysis of variance and aligned ranks over three latencies and two limbs."""
    effects = {one.name: one for one in rm_anova(data.measure, FACTORS).effects}
    yield "rm_anova_gg", effects["latency"].p_gg <= LEVEL
    yield "rm_anova_gg_interaction", effects[BOTH].p_gg <= LEVEL
    item = data.item.astype(np.float64)
    (latency, *_) = rm_anova(item, FACTORS).effects
    yield "rm_anova_item", latency.p_gg <= LEVEL
    aligned = {one.name: one for one in aligned_ranks_within(item, FACTORS).effects}
    yield "art", aligned["latency"].p <= LEVEL
    yield "art_interaction", aligned[BOTH].p <= LEVEL
    pairs = aligned_contrasts(item, (NAMES, LIMBS), (1,)).contrasts
    yield "art_c_holm", any(one.p_holm <= LEVEL for one in pairs)


def models(data: NullData, alpha: float, rng: np.random.Generator) -> Outcomes:
    """Fit the linear mixed model latency x limb with period, and the diagnostics of order."""
    n = len(data.measure)
    cells = list(product(range(n), range(len(NAMES)), range(len(LIMBS))))
    people = [who for who, _, _ in cells]
    latency = factor("latency", [LATENCIES_MS[one] for _, one, _ in cells], LATENCIES_MS)
    limb = factor("limb", [LIMBS[one] for _, _, one in cells], LIMBS)
    periods = [int(data.periods[who, one]) for who, one, _ in cells]
    design = build_design([latency, limb, factor("period", periods)], (), [FACTORS])
    values = data.measure.ravel()
    plain = fit_mixed_model(values, people, design)
    pairs = contrasts(plain, "latency")
    yield "mixed_model", _below(term_test(plain, "latency").p, made=plain.converged)
    yield "mixed_model_interaction", _below(term_test(plain, BOTH).p, made=plain.converged)
    yield "mixed_model_holm", _below(min(one.p_holm for one in pairs), made=plain.converged)
    slope = covariate("latency_s", [LATENCIES_MS[one] / 1000.0 for _, one, _ in cells])
    sloped = fit_mixed_model(values, people, design, random_slope=slope)
    yield "mixed_model_slope", _below(term_test(sloped, "latency").p, made=sloped.converged)
    order = carry_over(
        values, people, [LATENCIES_MS[one] for _, one, _ in cells], periods, further=[limb]
    )
    yield "carry_over", _below(order.carry_over.p, made=order.converged)
    yield "period", _below(order.period.p, made=order.converged)
    yield "sequence", _below(order.sequence.p if order.sequence else 1.0, made=order.converged)


def ordinal(data: NullData, alpha: float, rng: np.random.Generator) -> Outcomes:
    """Fit the cumulative link mixed model of the item on latency and limb, by Laplace's method."""
    cells = list(product(range(len(data.item)), LATENCIES_MS, LIMBS))
    design = build_design(
        [
            factor("latency", [one for _, one, _ in cells], LATENCIES_MS),
            factor("limb", [one for _, _, one in cells], LIMBS),
        ]
    )
    people = [who for who, _, _ in cells]
    (found,) = cumulative_term_tests(data.item.ravel(), people, design, terms=["latency"])
    yield "clmm_laplace", _below(found.test.p, made=found.test.converged)


def intervals(data: NullData, alpha: float, rng: np.random.Generator) -> Outcomes:
    """Return whether each 95 % interval contains the true value: alpha, or a difference of zero."""
    found = cronbach_alpha(data.scale)
    yield "alpha_interval", found.low <= alpha <= found.high
    differences = data.measure[:, -1, 0] - data.measure[:, 0, 0]
    student = mean_interval(differences)
    yield "student_mean", student.low <= 0.0 <= student.high
    for name, statistic in (("bca_mean", mean_of), ("bca_median", median_of)):
        interval = bootstrap_interval(differences, statistic, rng=rng)
        yield name, interval.low <= 0.0 <= interval.high


GROUPS: dict[str, Callable[[NullData, float, np.random.Generator], Outcomes]] = {
    "ranks": ranks,
    "means": means,
    "models": models,
    "ordinal": ordinal,
    "intervals": intervals,
}


def _below(p: float, *, made: bool) -> bool | None:
    return p <= LEVEL if made else None
