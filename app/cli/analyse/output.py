"""Format the results of `reembody analyse` for people: tables of figures, then notes."""

import math
from collections.abc import Iterator

from app.cli.analyse.families import Family
from app.cli.analyse.run import Analysis
from app.science.statistical_tests import statistical_test
from app.science.statistics import (
    AgainstReference,
    AlignedRanks,
    Comparison,
    MeanInterval,
    RmAnova,
)

_NONE = "-"
_LEAST_P = 0.0001
_WIDTH = 18
_LEGEND = (
    "Holm: over the pairs of one table. r: matched rank-biserial, positive if the first is larger.",
    "CI: 95 %, Student's t, for values that are approximately normal.",
)


def as_text(done: Analysis) -> str:
    """Format the result for people, with rounded figures; --json has every digit."""
    order, cells = done.order, done.cells
    factors = " x ".join(
        f"{name} ({', '.join(levels)})"
        for name, levels in zip(cells.factors, cells.levels, strict=True)
    )
    complete = f"{len(done.complete.subjects)} of {len(cells.subjects)} subjects complete"
    rows = f"{done.rows_used} rows used" + "".join(
        f", {count} left out ({reason if reason not in order.where else 'not ' + reason})"
        for reason, count in done.rows_left_out.items()
    )
    lines = [f"{order.measure} by {factors}: {complete}."]
    lines += [f"Note: {one}." for one in done.alike]
    lines += [f"{rows}.", *(f"Read: {one}." for one in done.read_as), "", *_means(done)]
    for family in done.families:
        lines += ["", *_family(family)]
    if done.rm_anova is not None:
        lines += ["", *_anova(done.rm_anova)]
    if done.aligned is not None:
        lines += ["", *_aligned(done.aligned)]
    lines += ["", *_LEGEND]
    others = (one.rstrip(".") for one in done.warnings if one not in done.alike)
    lines += [f"Note: {warning}." for warning in others]
    return "\n".join(lines)


def _means(done: Analysis) -> Iterator[str]:
    width = max(
        _WIDTH,
        2 + max(len(" ".join(one.levels.values())) for one in done.means),
        2 + len(" ".join(done.cells.factors)),
    )
    heads = " ".join(done.cells.factors)
    yield f"{heads:<{width}}{'n':>4}{'mean':>11}{'SD':>11}{'median':>11}{'CI of mean':>24}"
    for one in done.means:
        name = " ".join(one.levels.values())
        yield (
            f"{name:<{width}}{one.n:>4}{_figure(one.mean):>11}{_figure(one.sd):>11}"
            f"{_figure(one.median):>11}{_ends(one.interval):>24}"
        )


def _family(family: Family) -> Iterator[str]:
    question = family.question
    over = f", averaged over {', '.join(question.averaged_over)}" if question.averaged_over else ""
    at = "".join(f", {factor} {level}" for factor, level in question.at.items())
    yield f"{question.factor}{over}{at}"
    friedman, page = family.friedman, family.page
    if friedman is not None:
        exact = f"{_p(friedman.p)} exact, " if friedman.method == "exact" else ""
        yield (
            f"  Friedman  chi2({friedman.df}) = {friedman.statistic:.3f},"
            f" {exact}{_p(friedman.p_asymptotic)} asymptotic;"
            f" Kendall's W = {friedman.kendall_w:.3f}; n = {friedman.n}"
        )
    if page is not None:
        method = "exact given the ties" if page.method == "exact" else page.method
        yield (
            f"  Page      L = {page.statistic:g}, one-sided {_p(page.p_rises)} that it rises,"
            f" {_p(page.p_falls)} that it falls, {method}"
        )
    for key, outcome in family.further.items():
        yield f"  {statistical_test(key).name.en}  {outcome.sentence}"
    if family.pairs:
        yield from _pairs(family)
    if family.planned is not None:
        yield from _planned(family.planned, ordered=family.ordered)


def _pairs(family: Family) -> Iterator[str]:
    width = max(_WIDTH - 2, 2 + max(len(f"{one.a} - {one.b}") for one in family.pairs))
    yield (
        f"  {'Wilcoxon':<{width}}{'n':>4}{'zero':>6}{'W':>8}{'p':>9}{'p Holm':>9}{'r':>8}"
        f"{'mean diff':>12}{'CI':>24}"
    )
    figures = zip(family.pairs, family.mean_differences, family.intervals, strict=True)
    for one, mean, interval in figures:
        yield (
            f"  {f'{one.a} - {one.b}':<{width}}{one.test.n:>4}{one.test.n_zero:>6}{_tested(one)}"
            f"{_figure(mean):>12}{_ends(interval):>24}"
        )


def _tested(one: Comparison) -> str:
    """Format W, p, adjusted p and effect size; dashes for a test that says nothing."""
    if one.test.degenerate:
        return f"{_NONE:>8}{_NONE:>9}{_NONE:>9}{_NONE:>8}"
    return (
        f"{one.test.w:>8g}{_bare(one.test.p):>9}{_bare(one.p_holm):>9}"
        f"{one.test.rank_biserial:>8.3f}"
    )


def _planned(found: AgainstReference, *, ordered: bool) -> Iterator[str]:
    listed = ", ".join(
        f"{one.a} {one.test.degenerate or _p(one.p_holm)}" for one in found.comparisons
    )
    differ = [one.a for one in found.comparisons if one.p_holm <= found.alpha]
    yield f"  Against {found.reference}, Holm over these: {listed}"
    if not differ:
        yield f"  No level differs from {found.reference} at {found.alpha:g}"
    elif ordered:
        yield f"  First level that differs from {found.reference}: {differ[0]}"
    else:
        yield f"  Levels that differ from {found.reference}: {', '.join(differ)}"


def _anova(found: RmAnova) -> Iterator[str]:
    width = max(_WIDTH, 2 + max(len(one.name) for one in found.effects))
    yield (
        f"{'rm ANOVA':<{width}}{'df':>9}{'F':>10}{'p':>9}{'GG eps':>9}{'p GG':>9}"
        f"{'part. eta2':>12}{'gen. eta2':>11}"
    )
    for one in found.effects:
        df = f"{one.df:g}, {one.df_error:g}"
        yield (
            f"{one.name:<{width}}{df:>9}{one.f:>10.3f}{_bare(one.p):>9}{one.epsilon:>9.3f}"
            f"{_bare(one.p_gg):>9}{one.partial_eta_squared:>12.3f}"
            f"{one.generalised_eta_squared:>11.3f}"
        )


def _aligned(found: AlignedRanks) -> Iterator[str]:
    width = max(_WIDTH, 2 + max(len(one.name) for one in found.effects))
    yield f"{'aligned ranks':<{width}}{'df':>9}{'F':>10}{'p':>9}{'p GG':>9}"
    for one in found.effects:
        df = f"{one.df:g}, {one.df_error:g}"
        yield f"{one.name:<{width}}{df:>9}{one.f:>10.3f}{_bare(one.p):>9}{_bare(one.p_gg):>9}"
    yield f"  {found.caution}"


def _p(p: float) -> str:
    return f"p < {_LEAST_P:.4f}" if p < _LEAST_P else f"p = {p:.4f}"


def _bare(p: float) -> str:
    return f"<{_LEAST_P:.4f}" if p < _LEAST_P else f"{p:.4f}"


def _figure(value: float) -> str:
    return _NONE if math.isnan(value) else f"{value:.4g}"


def _ends(one: MeanInterval | None) -> str:
    return _NONE if one is None else f"[{_figure(one.low)}, {_figure(one.high)}]"
