"""Tests of latency or body with limb: analysis of variance, mixed model and carry-over."""

from collections.abc import Iterator, Sequence

import numpy as np

from app.features.results.analysis.questions.measures import Measure
from app.features.results.analysis.questions.words import (
    TestReport,
    against,
    bounded,
    df_words,
    error_rate_warning,
    number,
    p_cell,
    p_words,
)
from app.science.statistical_tests import statistical_test
from app.science.statistics import (
    Effect,
    StatisticsError,
    rm_anova,
)
from app.science.statistics.mixed import (
    TermTest,
    build_design,
    carry_over,
    factor,
    fit_mixed_model,
    term_tests,
)

MIXED_SOURCE = (
    "Laird and Ware 1982, Biometrics 38:963; Kuznetsova et al. 2017, J. Stat. Softw. 82(13)."
)
CARRY_SOURCE = "Jones and Kenward 2014, Design and Analysis of Cross-Over Trials."
_MIN_LIMBS = 2
MAX_FOR_MODELS = 200
_UNTESTABLE = (StatisticsError, np.linalg.LinAlgError)
_TOO_MANY = (
    f"Not computed: with more than {MAX_FOR_MODELS} participants, fitting takes minutes. Export "
    "the data and fit the model there."
)


def model_results(measure: Measure, alpha: float) -> Iterator[TestReport]:
    """Yield an analysis of variance and a mixed model of the factor x limb."""
    if len(measure.limbs) < _MIN_LIMBS:
        return
    name = measure.factor.name.capitalize()
    for test, key, title in (
        (_anova, "rm_anova", f"{name} × limb, analysis of variance"),
        (_mixed, "mixed_model", f"{name} × limb, mixed model with period"),
    ):
        try:
            yield test(measure, alpha, key, title)
        except _UNTESTABLE as error:
            yield TestReport(
                key, title, f"This cannot be tested. {_why(error, measure)}", "", (), (), "", ""
            )


def carry_over_result(measure: Measure) -> Iterator[TestReport]:
    """Yield a diagnostic of order, period and carry-over effects; it is not a hypothesis test."""
    places, key = measure.places, "carry_over"
    title = "Order, period and carry-over (diagnostic)"
    if places["participant_code"].nunique() > MAX_FOR_MODELS:
        yield TestReport(key, title, _TOO_MANY, "", (), (), "", CARRY_SOURCE, exploratory=True)
        return
    limbs = [factor("limb", places["limb"].tolist())] if len(measure.limbs) > 1 else []
    try:
        found = carry_over(
            places["value"].to_numpy(dtype=np.float64),
            places["participant_code"].tolist(),
            places[measure.factor.column].tolist(),
            [int(one) for one in places["block"]],
            further=limbs,
        )
    except _UNTESTABLE as error:
        why = _why(error, measure)
        yield TestReport(key, title, f"This cannot be tested. {why}", "", (), (), "", "")
        return
    tests: Sequence[TermTest] = [
        one
        for one in (found.condition, found.period, found.carry_over, found.sequence)
        if one is not None
    ]
    yield TestReport(
        key=key,
        title=title,
        sentence=" ".join(one.text for one in found.conclusions),
        apa="",
        columns=("term", "F", "df", "p"),
        rows=[_term_row(one) for one in tests],
        method=(
            "Linear mixed model with condition, period, limb and first-order carry-over, random "
            f"intercepts; {found.left_out} observations without a known block before left out."
        ),
        source=CARRY_SOURCE,
        warnings=[
            error_rate_warning("carry_over"),
            "" if found.converged else "The fit did not converge.",
        ],
        exploratory=True,
    )


def _why(error: Exception, measure: Measure) -> str:
    """Return the reason why no model was fitted; numerical failure means no residual variance."""
    if isinstance(error, StatisticsError):
        return str(error)
    factor = measure.factor.plural
    return f"Participants, {factor} and limbs explain the measure completely: nothing is left over."


def _anova(measure: Measure, alpha: float, key: str, title: str) -> TestReport:
    cells = measure.cells()
    found = rm_anova(cells, (measure.factor.name, "limb"))
    parts = [_effect_words(one) for one in found.effects]
    comparisons = [
        f"{one.name.replace(':', ' × ')}: {against(one.p_gg, alpha)}" for one in found.effects
    ]
    return TestReport(
        key=key,
        title=title,
        sentence=f"With {found.n} complete participants, {'; '.join(comparisons)}.",
        apa=f"{measure.title}: {'; '.join(parts)}",
        columns=("effect", "F", "df", "ε (GG)", "p (GG)", "generalised η²", "partial η²"),
        rows=[
            (
                one.name.replace(":", " × "),
                number(one.f),
                f"{df_words(one.df)}, {df_words(one.df_error)}",
                bounded(one.epsilon),
                p_cell(one.p_gg),
                bounded(one.generalised_eta_squared),
                bounded(one.partial_eta_squared),
            )
            for one in found.effects
        ],
        method=(
            "Analysis of variance with two within-subject factors, Greenhouse and Geisser’s "
            "correction; participants without every cell are left out. Limb is confounded with "
            "time where one limb always came first."
        ),
        source=statistical_test("rm_anova").source,
        warnings=(error_rate_warning("rm_anova_gg"), error_rate_warning("rm_anova_gg_interaction")),
    )


def _effect_words(one: Effect) -> str:
    df, error = one.df * one.epsilon, one.df_error * one.epsilon
    return (
        f"{one.name.replace(':', ' × ')} F({number(df)}, {number(error)}) = {number(one.f)}, "
        f"{p_words(one.p_gg)}, η²G = {bounded(one.generalised_eta_squared)}"
    )


def _mixed(measure: Measure, alpha: float, key: str, title: str) -> TestReport:
    places = measure.places
    if places["participant_code"].nunique() > MAX_FOR_MODELS:
        return TestReport(key, title, _TOO_MANY, "", (), (), "", MIXED_SOURCE)
    name = measure.factor.name
    level = factor(name, places[measure.factor.column].tolist())
    limb, period = (
        factor(a, places[b].tolist()) for a, b in (("limb", "limb"), ("period", "block"))
    )
    design = build_design([level, limb, period], interactions=[(name, "limb")])
    values = places["value"].to_numpy(dtype=np.float64)
    model = fit_mixed_model(values, places["participant_code"].tolist(), design)
    tests = term_tests(model)
    comparisons = [f"{_term(one)}: {against(one.p, alpha)}" for one in tests]
    parts = [
        f"{_term(one)} F({one.df_term}, {df_words(one.df_error)}) = {number(one.f)}, "
        f"{p_words(one.p)}"
        for one in tests
    ]
    return TestReport(
        key=key,
        title=title,
        sentence=(
            f"With {model.participants} participants and {model.observations} phases, "
            f"{'; '.join(comparisons)}."
        ),
        apa=f"{measure.title}, linear mixed model: {'; '.join(parts)}",
        columns=("term", "F", "df", "p"),
        rows=[_term_row(one) for one in tests],
        method=(
            "Linear mixed model (REML), random intercept of participants, F tests with "
            "Satterthwaite’s degrees of freedom. Uses every existing phase; nobody is left "
            "out for a missing cell."
        ),
        source=MIXED_SOURCE,
        warnings=[
            *model.messages,
            error_rate_warning("mixed_model"),
            error_rate_warning("mixed_model_interaction"),
        ],
    )


def _term_row(one: TermTest) -> tuple[str, ...]:
    df = f"{one.df_term}, {df_words(one.df_error)}"
    return _term(one), number(one.f), df, p_cell(one.p)


def _term(one: TermTest) -> str:
    return one.term.replace(":", " × ").replace("_", "-")
