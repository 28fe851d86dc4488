"""Convert the results of `reembody analyse` to JSON; what could not be computed is null."""

import math
from typing import Any

from app.cli.analyse.families import Family
from app.cli.analyse.run import Analysis, CellMean
from app.science.statistics import (
    AgainstReference,
    Comparison,
    Effect,
    Friedman,
    MeanInterval,
    PageTrend,
)


def as_json(done: Analysis) -> dict[str, Any]:
    """Return the result for scripts, with unrounded p values and effects.

    `friedman`, `pairwise` and `page` are those of the first factor, averaged over the second if
    there is one; `families` has them for every factor, and at each level of the second.
    """
    first = _family_json(done.families[0])
    art = done.aligned
    result: dict[str, Any] = {
        "n": len(done.complete.subjects),
        "rows_used": done.rows_used,
        "rows_left_out": sum(done.rows_left_out.values()),
        "rows_left_out_because": [
            {"reason": f"not {reason}" if reason in done.order.where else reason, "rows": count}
            for reason, count in done.rows_left_out.items()
        ],
        "design": _design(done),
        "means": [_mean(one) for one in done.means],
        "friedman": first["friedman"],
        "pairwise": first["pairwise"],
        "page": first["page"],
        "against_reference": first["against_reference"],
        "rm_anova": [_effect(one) for one in done.rm_anova.effects] if done.rm_anova else [],
        "families": [_family_json(one) for one in done.families],
        "aligned_ranks": {"effects": [_effect(one) for one in art.effects], "caution": art.caution}
        if art
        else None,
        "missing": {
            "cells": done.cells.n_missing,
            "empty_rows": done.cells.n_empty,
            "averaged_cells": done.cells.n_averaged,
            "averaged_over": list(done.averaged_over),
            "left_out_listwise": list(done.complete.left_out),
            "rule": "listwise for Friedman, Page and ANOVA; pairwise for Wilcoxon; none imputed",
        },
        "read_as": list(done.read_as),
        "warnings": done.warnings,
    }
    return {key: _finite(one) for key, one in result.items()}


def _design(done: Analysis) -> dict[str, Any]:
    return {
        "subject": done.order.subject,
        "measure": done.order.measure,
        "within": [
            {"factor": factor, "levels": list(levels)}
            for factor, levels in zip(done.cells.factors, done.cells.levels, strict=True)
        ],
        "subjects": len(done.cells.subjects),
        "complete_subjects": len(done.complete.subjects),
    }


def _mean(one: CellMean) -> dict[str, Any]:
    return {
        "levels": one.levels,
        "n": one.n,
        "mean": one.mean,
        "sd": one.sd,
        "median": one.median,
        "ci": _interval(one.interval),
    }


def _family_json(family: Family) -> dict[str, Any]:
    return {
        "factor": family.question.factor,
        "levels": list(family.question.levels),
        "averaged_over": list(family.question.averaged_over),
        "at": family.question.at,
        "friedman": _friedman(family.friedman),
        "pairwise": [
            _pair(*one)
            for one in zip(family.pairs, family.mean_differences, family.intervals, strict=True)
        ],
        "page": _page(family.page),
        "against_reference": _planned(family.planned, ordered=family.ordered),
        **{
            key: {"n": outcome.n, "p": outcome.p, "words": outcome.sentence}
            for key, outcome in family.further.items()
        },
    }


def _friedman(test: Friedman | None) -> dict[str, Any] | None:
    if test is None:
        return None
    named = ("statistic", "df", "p", "p_asymptotic", "kendall_w", "method", "n")
    return {**_values(test, *named), "mean_ranks": list(test.mean_ranks)}


def _pair(one: Comparison, mean: float, interval: MeanInterval | None) -> dict[str, Any]:
    return {
        **_tested(one),
        "mean_difference": mean,
        "mean_difference_ci": _interval(interval),
    }


def _tested(one: Comparison) -> dict[str, Any]:
    sizes = ("n", "n_zero", "n_left_out", "zeros")
    found = {
        **_values(one, "a", "b"),
        **_values(one.test, "w", "p"),
        **_values(one, "p_holm"),
        **_values(one.test, "rank_biserial", "p_asymptotic", "method", *sizes),
        **_values(one, "median_difference"),
        "degenerate": one.test.degenerate or None,
    }
    if one.test.degenerate:
        found |= dict.fromkeys(("w", "p", "p_holm", "p_asymptotic", "rank_biserial"))
    return found


def _planned(planned: AgainstReference | None, *, ordered: bool) -> dict[str, Any] | None:
    if planned is None:
        return None
    return {
        "reference": planned.reference,
        "first_that_differs": planned.first_that_differs if ordered else None,
        "alpha": planned.alpha,
        "comparisons": [_tested(one) for one in planned.comparisons],
    }


def _page(test: PageTrend | None) -> dict[str, Any] | None:
    if test is None:
        return None
    by_tables = test.method == "exact"
    return {
        "statistic": test.statistic,
        "p": test.p_rises,
        "p_falling": test.p_falls,
        **_values(test, "p_given_ties", "p_falling_given_ties"),
        "p_by_tables": test.p if by_tables else None,
        "p_falling_by_tables": test.p_falling if by_tables else None,
        **_values(test, "p_asymptotic", "method", "n"),
    }


def _effect(one: Effect) -> dict[str, Any]:
    test = ("f", "df", "df_error", "p", "epsilon", "p_gg")
    sizes = ("partial_eta_squared", "generalised_eta_squared")
    return {
        "effect": one.name,
        **_values(one, *test, *sizes, "mauchly_w", "mauchly_p", "ss", "ss_error"),
    }


def _interval(one: MeanInterval | None) -> dict[str, Any] | None:
    if one is None:
        return None
    return _values(one, "low", "high", "confidence")


def _values(one: object, *names: str) -> dict[str, Any]:
    """Return the named attributes of a result as a dictionary."""
    return {name: getattr(one, name) for name in names}


def _finite(value: object) -> object:
    """Replace numbers that are not finite by None, because JSON has no NaN."""
    if isinstance(value, dict):
        return {key: _finite(one) for key, one in value.items()}
    if isinstance(value, list):
        return [_finite(one) for one in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None
    return value
