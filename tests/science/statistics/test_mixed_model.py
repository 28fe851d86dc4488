"""Tests of the linear mixed model against lme4, lmerTest and the analysis of variance."""

import csv
from pathlib import Path

import numpy as np
import pytest
import scipy.stats

from app.science.statistics.mixed.design import Design, build_design
from app.science.statistics.mixed.likelihood import Rows, restricted_likelihood
from app.science.statistics.mixed.model import MixedModel, fit_mixed_model
from app.science.statistics.mixed.term_tests import (
    contrasts,
    fixed_effects,
    marginal_means,
    term_tests,
)
from app.science.statistics.mixed.terms import ModelError, covariate, factor

LATENCIES = (0, 125, 350)
LIMBS = ("hand", "foot")


@pytest.fixture(scope="module")
def sleep(shared_data: Path) -> MixedModel:
    """Fit reactions over days without sleep, random intercept and slope (Belenky 2003; lme4)."""
    with (shared_data / "statistics" / "sleepstudy.csv").open() as file:
        rows = list(csv.DictReader(file))
    days = covariate("days", [float(row["Days"]) for row in rows])
    return fit_mixed_model(
        [float(row["Reaction"]) for row in rows],
        [row["Subject"] for row in rows],
        build_design([], [days]),
        random_slope=days,
    )


def study(
    seed: int, participants: int = 12, spread: float = 2.0
) -> tuple[np.ndarray, list[int], Design]:
    """Return a balanced 3 x 2 experiment without effects."""
    rng = np.random.default_rng(seed)
    cells = [(who, one, two) for who in range(participants) for one in LATENCIES for two in LIMBS]
    people = [who for who, _, _ in cells]
    level = spread * rng.normal(size=participants)
    values = level[people] + rng.normal(size=len(cells))
    design = build_design(
        [
            factor("latency", [one for _, one, _ in cells], LATENCIES),
            factor("limb", [two for _, _, two in cells], LIMBS),
        ],
        interactions=[("latency", "limb")],
    )
    return values, people, design


def test_the_sleep_study_is_that_of_lme4(sleep: MixedModel) -> None:
    """Effects, REML criterion and variances of the sleep study equal lme4's published fit.

    Its releases print 612.09 or 612.10 for the intercepts' variance, by the optimiser they had.
    """
    intercept, days = fixed_effects(sleep)
    assert intercept.value.estimate == pytest.approx(251.4051, abs=5e-5)
    assert days.value.estimate == pytest.approx(10.4673, abs=5e-5)
    assert sleep.reml_criterion == pytest.approx(1743.628, abs=5e-4)
    assert sleep.random_covariance[0, 0] == pytest.approx(612.10, abs=0.015)
    assert sleep.random_covariance[1, 1] == pytest.approx(35.07, abs=0.005)
    assert sleep.residual_sd == pytest.approx(25.592, abs=5e-4)
    assert (sleep.converged, sleep.singular, sleep.messages) == (True, False, ())


def test_degrees_of_freedom_of_the_sleep_study(sleep: MixedModel) -> None:
    """The sleep study's mean slope has 18 - 1 df, as each participant has a line (lmerTest)."""
    _, days = fixed_effects(sleep)
    assert days.value.se == pytest.approx(1.5458, abs=5e-5)
    assert days.value.df == pytest.approx(17.0, abs=0.01)


def test_balanced_data_give_the_analysis_of_variance() -> None:
    """Without missing cells the mixed model's F and df are those of the additive ANOVA."""
    values, people, design = study(3)
    cube = values.reshape(12, 3, 2)
    means = cube.mean(axis=(0, 2))
    squares = 24 * ((means - means.mean()) ** 2).sum() / 2
    table = values.reshape(12, 6)
    left = table - table.mean(axis=0) - table.mean(axis=1, keepdims=True) + table.mean()
    error = (left**2).sum() / 55
    latency, limb, both = term_tests(fit_mixed_model(values, people, design))
    assert latency.f == pytest.approx(squares / error, rel=1e-4)
    assert [(one.df_term, round(one.df_error, 3)) for one in (latency, limb, both)] == [
        (2, 55.0),
        (1, 55.0),
        (2, 55.0),
    ]
    assert latency.p == pytest.approx(scipy.stats.f.sf(squares / error, 2, 55), rel=1e-3)


def test_the_gradient_is_that_of_the_criterion() -> None:
    """The analytic gradient equals numeric differences of the restricted likelihood."""
    values, people, design = study(5)
    z = np.column_stack([np.ones(len(values)), np.tile([0.0, 1.0], 36)])
    rows = Rows(values, design.matrix, z, np.array(people))
    at = np.array([2.0, 0.3, 0.7, 1.4])

    def look(phi: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
        g = np.array([[phi[0], phi[1]], [phi[1], phi[2]]])
        found = restricted_likelihood(rows, g, float(phi[3]))
        return found.criterion, found.gradient, found.covariance

    found = restricted_likelihood(rows, np.array([[2.0, 0.3], [0.3, 0.7]]), 1.4)
    for index, step in enumerate(1e-5 * np.eye(4)):
        ahead, behind = look(at + step), look(at - step)
        assert found.gradient[index] == pytest.approx((ahead[0] - behind[0]) / 2e-5, abs=1e-5)
        assert found.hessian[index] == pytest.approx((ahead[1] - behind[1]) / 2e-5, abs=1e-5)
        assert found.slopes[index] == pytest.approx((ahead[2] - behind[2]) / 2e-5, abs=1e-7)


def test_an_equal_shift_of_all_changes_the_intercept_alone() -> None:
    """Adding a constant, or changing the unit, leaves every test unchanged."""
    values, people, design = study(7)
    plain = term_tests(fit_mixed_model(values, people, design))
    other = term_tests(fit_mixed_model(1000.0 * values + 4e4, people, design))
    assert [one.f for one in other] == pytest.approx([one.f for one in plain], rel=1e-3)


def test_participants_who_do_not_differ_are_reported() -> None:
    """A zero variance is reported as singular, with the df of plain regression."""
    values, people, design = study(11, spread=0.0)
    values = values - np.repeat(values.reshape(12, 6).mean(axis=1), 6)
    model = fit_mixed_model(values, people, design)
    assert model.singular
    assert "zero" in model.messages[0]
    assert term_tests(model)[0].df_error == pytest.approx(72 - 6)


def test_missing_cells_are_allowed() -> None:
    """A participant without two cells stays in, and marginal means weigh cells equally."""
    values, people, _ = study(13)
    cells = [(one, two) for _ in range(12) for one in LATENCIES for two in LIMBS]
    remaining = [at for at in range(len(values)) if at not in (0, 7)]
    design = build_design(
        [
            factor("latency", [cells[at][0] for at in remaining], LATENCIES),
            factor("limb", [cells[at][1] for at in remaining], LIMBS),
        ],
        interactions=[("latency", "limb")],
    )
    model = fit_mixed_model(values[remaining], [people[at] for at in remaining], design)
    single = marginal_means(model, "latency", by="limb")
    joint = marginal_means(model, "latency")
    assert len(single) == 6
    for at, one in enumerate(joint):
        cellwise = (single[at].value.estimate + single[at + 3].value.estimate) / 2
        assert one.value.estimate == pytest.approx(cellwise)


def test_contrasts_can_be_against_one_level_within_another_factor() -> None:
    """Each latency is compared with 0 ms within each limb, with Holm over two comparisons."""
    values, people, design = study(17)
    found = contrasts(fit_mixed_model(values, people, design), "latency", by="limb", against="0")
    assert [(one.a, one.b, one.within) for one in found] == [
        ("125", "0", "hand"),
        ("350", "0", "hand"),
        ("125", "0", "foot"),
        ("350", "0", "foot"),
    ]
    hand = sorted(found[:2], key=lambda one: one.value.p)
    assert hand[0].p_holm == pytest.approx(min(1.0, 2 * hand[0].value.p))


def test_linearly_dependent_terms_are_rejected() -> None:
    """Linearly dependent terms raise an error with the coefficient that cannot be estimated."""
    with pytest.raises(ModelError, match=r"limb\[b\] cannot be estimated"):
        build_design([factor("block", [1, 2, 1, 2]), factor("limb", ["a", "b", "a", "b"])])


@pytest.mark.parametrize(
    ("values", "people", "expected_message"),
    [
        ([1.0, 2.0, float("nan"), 3.0, 2.0, 1.0], [1, 1, 2, 2, 3, 3], "finite"),
        ([1.0, 2.0, 3.0, 3.0, 2.0, 1.0], [1, 2, 3, 4, 5, 6], "two or more"),
        ([1.0, 2.0, 3.0, 3.0, 2.0, 1.0], [1, 1, 1, 2, 2, 2], "three or more"),
        ([1.0, 2.0, 3.0], [1, 2, 3], "do not fit"),
    ],
)
def test_data_that_cannot_be_fitted_are_rejected(
    values: list[float], people: list[int], expected_message: str
) -> None:
    """Missing values, too few people and single observations are rejected."""
    design = build_design([factor("limb", ["a", "b", "a", "b", "a", "b"])])
    with pytest.raises(ModelError, match=expected_message):
        fit_mixed_model(values, people, design)


def test_a_slope_never_fits_worse_than_none() -> None:
    """A model with a random slope never has a worse criterion than one without."""
    for seed in range(4):
        values, people, design = study(seed)
        slope = covariate("foot", np.tile([-0.5, 0.5], 36))
        plain = fit_mixed_model(values, people, design)
        sloped = fit_mixed_model(values, people, design, random_slope=slope)
        assert sloped.converged
        assert sloped.reml_criterion <= plain.reml_criterion + 1e-4
