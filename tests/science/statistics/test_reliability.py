"""Tests of alpha, omega, bootstrap intervals and power: identities and limits."""

import math

import numpy as np
import pytest

from app.science.statistics import (
    ConstantData,
    Expected,
    StatisticsError,
    TooFewData,
    bootstrap_interval,
    cronbach_alpha,
    mcdonald_omega,
    mean_interval,
    mean_of,
    median_of,
    rm_anova_power,
    subjects_needed,
    within_subject_intervals,
)
from app.science.statistics.arrays import FloatArray


def _with_covariance(loadings: list[float], errors: list[float], n: int = 60) -> FloatArray:
    """Return answers whose sample covariance is exactly l l' + diag(e)."""
    rng = np.random.default_rng(1)
    k = len(loadings)
    drawn = rng.normal(size=(n, k))
    drawn -= drawn.mean(axis=0)
    white = drawn @ np.linalg.inv(np.linalg.cholesky(np.cov(drawn, rowvar=False))).T
    covariance = np.outer(loadings, loadings) + np.diag(errors)
    answers: FloatArray = white @ np.linalg.cholesky(covariance).T
    return answers


def test_items_that_load_alike_have_omega_equal_to_alpha() -> None:
    """Four items with loading 1 and error 1 have omega and alpha of 16 / (16 + 4)."""
    answers = _with_covariance([1.0] * 4, [1.0] * 4)
    omega = mcdonald_omega(answers, rng=np.random.default_rng(1), resamples=99)
    assert omega.omega == pytest.approx(0.8, abs=1e-9)
    assert cronbach_alpha(answers).alpha == pytest.approx(0.8, abs=1e-9)


def test_omega_recovers_unequal_loadings_where_alpha_is_too_low() -> None:
    """Omega of loadings .9, .7, .5, .3 is (2.4)^2 / ((2.4)^2 + sum of errors); alpha is lower."""
    loadings = [0.9, 0.7, 0.5, 0.3]
    errors = [1.0 - one * one for one in loadings]
    answers = _with_covariance(loadings, errors)
    result = mcdonald_omega(answers, rng=np.random.default_rng(1), resamples=199)
    truth = 2.4**2 / (2.4**2 + sum(errors))
    assert result.omega == pytest.approx(truth, abs=1e-6)
    assert result.loadings == pytest.approx(loadings, abs=1e-5)
    assert not result.heywood
    assert cronbach_alpha(answers).alpha < truth
    assert result.interval.low < truth < result.interval.high
    assert "minres" in result.estimator


def test_incomplete_answers_are_left_out_and_counted() -> None:
    """A subject who skipped an item is left out and counted."""
    answers = np.vstack([_with_covariance([1.0] * 4, [1.0] * 4), [1.0, 2.0, math.nan, 1.0]])
    result = cronbach_alpha(answers)
    assert (result.n, result.n_left_out) == (60, 1)
    assert result.alpha == pytest.approx(0.8, abs=1e-9)
    assert result.without_item == pytest.approx([0.75] * 4)


def test_scales_that_have_no_reliability_are_rejected() -> None:
    """Constant sums or items, one item, and two items for omega are rejected."""
    with pytest.raises(ConstantData, match="sum of the 2 items"):
        cronbach_alpha([[1.0, 2.0], [2.0, 1.0], [3.0, 0.0]])
    with pytest.raises(TooFewData, match="2 items"):
        cronbach_alpha([[1.0], [2.0]])
    with pytest.raises(TooFewData, match="3 of each"):
        mcdonald_omega([[1.0, 2.0], [2.0, 1.0]], rng=np.random.default_rng(1))
    with pytest.raises(ConstantData, match="Item 2 of 3"):
        mcdonald_omega(
            [[1.0, 5.0, 1.0], [2.0, 5.0, 2.0], [3.0, 5.0, 1.0]], rng=np.random.default_rng(1)
        )


def test_an_interval_can_be_computed_again() -> None:
    """The same seed gives the same bootstrap interval; another seed nearly the same."""
    data = np.random.default_rng(6).gamma(2.0, size=20)
    one, same, other = (
        bootstrap_interval(data, mean_of, rng=np.random.default_rng(seed)) for seed in (1, 1, 2)
    )
    assert one == same
    assert one.low != other.low
    assert one.low == pytest.approx(other.low, abs=0.05)
    assert one.low < one.estimate < one.high
    assert (one.method, one.n) == ("BCa", 20)


def test_intervals_move_with_unit_and_origin() -> None:
    """A bootstrap interval of the median scales and shifts with the data."""
    data = np.random.default_rng(7).normal(size=15)
    metres = bootstrap_interval(data, median_of, rng=np.random.default_rng(1))
    other = bootstrap_interval(100.0 * data + 5.0, median_of, rng=np.random.default_rng(1))
    assert other.low == pytest.approx(100.0 * metres.low + 5.0)
    assert other.high == pytest.approx(100.0 * metres.high + 5.0)


def test_values_that_are_all_equal_have_an_interval_of_no_width() -> None:
    """The interval of equal values has no width and is not called BCa."""
    found = bootstrap_interval(np.full(5, 3.0), mean_of, rng=np.random.default_rng(1))
    assert (found.low, found.high, found.method) == (3.0, 3.0, "percentile")
    with pytest.raises(TooFewData, match="at least 2"):
        bootstrap_interval([1.0], mean_of, rng=np.random.default_rng(1))


def test_the_interval_of_a_mean_is_students() -> None:
    """The interval of a mean is Student's, and NaN is left out.

    Five values by hand: mean 3, SD sqrt(2.5), t .975 with 4 df 2.776445.
    """
    found = mean_interval([1.0, 2.0, 3.0, math.nan, 4.0, 5.0])
    reach = 2.776445 * math.sqrt(2.5 / 5.0)
    assert (found.mean, found.n, found.kind) == (3.0, 5, "between")
    assert (found.low, found.high) == pytest.approx((3.0 - reach, 3.0 + reach), abs=1e-6)
    with pytest.raises(TooFewData, match="1 values"):
        mean_interval([1.0, math.nan])


def test_intervals_within_subjects_leave_out_how_subjects_differ() -> None:
    """Within-subject intervals ignore differences between subjects.

    Those of two conditions are 1/sqrt(2) as wide as that of their difference.
    """
    values = np.random.default_rng(9).normal(size=(12, 2))
    apart = values + 100.0 * np.arange(12.0)[:, np.newaxis]
    near, far = within_subject_intervals(values), within_subject_intervals(apart)
    difference = mean_interval(values[:, 0] - values[:, 1])
    for one, other in zip(near, far, strict=True):
        assert one.sd == pytest.approx(other.sd)
        assert one.high - one.low == pytest.approx((difference.high - difference.low) / 2**0.5)


def test_power_grows_with_subjects_and_effect_and_is_alpha_without_one() -> None:
    """Power grows with subjects and effect, and without an effect is the test's alpha."""
    powers = [rm_anova_power(n, Expected(0.1)) for n in (4, 8, 16, 32)]
    assert powers == sorted(powers)
    assert rm_anova_power(12, Expected(0.2)) > rm_anova_power(12, Expected(0.1))
    assert rm_anova_power(12, Expected(1e-9)) == pytest.approx(0.05, abs=1e-6)
    needed = subjects_needed(0.9, Expected(0.1))
    assert rm_anova_power(needed, Expected(0.1)) >= 0.9 > rm_anova_power(needed - 1, Expected(0.1))


def test_impossible_effects_are_rejected() -> None:
    """Impossible arguments of a power analysis are rejected by name and value."""
    with pytest.raises(StatisticsError, match=r"partial eta squared 1\.5"):
        Expected(1.5)
    with pytest.raises(StatisticsError, match=r"epsilon 0\.3; valid from 0\.500"):
        Expected(0.1, epsilon=0.3)
    with pytest.raises(StatisticsError, match="at least 2"):
        rm_anova_power(1, Expected(0.1))
    with pytest.raises(StatisticsError, match="More than"):
        subjects_needed(0.8, Expected(1e-9))
