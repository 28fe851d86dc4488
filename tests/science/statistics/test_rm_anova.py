"""Tests of repeated-measures ANOVA: identities, invariances, designs that cannot be tested."""

import math

import numpy as np
import pytest

from app.science.statistics import (
    ConstantData,
    StatisticsError,
    TooFewData,
    rm_anova,
    split_plot_anova,
)
from app.science.statistics.arrays import complete_rows
from app.science.statistics.effects import contrasts, greenhouse_geisser, mauchly
from tests.science.statistics.published import pingouin_table, wide


def test_two_levels_are_a_paired_t_test() -> None:
    """With two levels F is the square of the paired t, and epsilon is 1."""
    rng = np.random.default_rng(1)
    values = rng.normal((0.0, 0.5), size=(12, 2))
    (effect,) = rm_anova(values).effects
    difference = values[:, 0] - values[:, 1]
    t = difference.mean() / (difference.std(ddof=1) / math.sqrt(12))
    assert effect.f == pytest.approx(t * t, rel=1e-12)
    assert effect.epsilon == 1.0
    assert effect.p_gg == effect.p
    assert math.isnan(effect.mauchly_w)


def test_the_sums_of_squares_add_up() -> None:
    """Sums of squares of effects, errors and subjects add up to the total of a 3 x 2 design."""
    values = np.random.default_rng(2).normal(size=(7, 3, 2))
    effects = rm_anova(values, ("latency", "limb")).effects
    subjects = values.mean(axis=(1, 2))
    between = 6.0 * float(np.square(subjects - subjects.mean()).sum())
    total = float(np.square(values - values.mean()).sum())
    assert between + sum(one.ss + one.ss_error for one in effects) == pytest.approx(total)
    assert [one.name for one in effects] == ["latency", "limb", "latency:limb"]


def test_unit_origin_and_order_do_not_matter() -> None:
    """Unit, origin and the order of subjects and levels do not change F and epsilon."""
    rng = np.random.default_rng(3)
    values = rng.normal(size=(9, 3, 2))
    before = rm_anova(values).effects
    moved = (250.0 * values - 40.0)[rng.permutation(9)][:, [2, 0, 1]][:, :, ::-1]
    for one, other in zip(before, rm_anova(moved).effects, strict=True):
        assert other.f == pytest.approx(one.f, rel=1e-9)
        assert other.epsilon == pytest.approx(one.epsilon, rel=1e-9)
        assert other.generalised_eta_squared == pytest.approx(one.generalised_eta_squared)


def test_epsilon_is_one_with_sphericity_and_its_least_without() -> None:
    """Epsilon is 1 under sphericity and minimal when all contrasts are proportional."""
    assert greenhouse_geisser(np.eye(4)) == pytest.approx(1.0)
    assert greenhouse_geisser(np.ones((4, 4))) == pytest.approx(0.25)
    assert mauchly(np.eye(3), 10) == pytest.approx((1.0, 1.0))


def test_contrasts_are_orthonormal_and_add_up_to_zero() -> None:
    """The contrasts of two to six levels are orthonormal and sum to zero."""
    for levels in range(2, 7):
        columns = contrasts(levels)
        assert columns.T @ columns == pytest.approx(np.eye(levels - 1), abs=1e-12)
        assert columns.sum(axis=0) == pytest.approx(np.zeros(levels - 1), abs=1e-12)


def test_mauchly_agrees_with_pingouin() -> None:
    """Mauchly's test agrees with pingouin 0.7's `sphericity` of `rm_anova_wide`.

    W .30678, p .16336. R and pingouin put the number of levels, not of contrasts, into the last
    term of p.
    """
    complete, _ = complete_rows(wide(pingouin_table("rm_anova_wide")))
    (effect,) = rm_anova(complete).effects
    assert effect.mauchly_w == pytest.approx(0.30678, abs=5e-6)
    assert effect.mauchly_p == pytest.approx(0.16336, abs=2e-4)


def test_groups_of_unequal_size_count_equally() -> None:
    """The within-subjects mean is the mean of the groups' means, whatever their size (type III)."""
    rng = np.random.default_rng(4)
    values = rng.normal(size=(8, 3))
    groups = ["a"] * 4 + ["b"] * 4
    result = split_plot_anova(values, groups)
    assert result.group_sizes == (4, 4)
    # With equal groups the mean within is that of all subjects.
    mean = values.mean(axis=0)
    expected = 8.0 * float(np.square(mean - mean.mean()).sum())
    assert result.within.ss == pytest.approx(expected)
    uneven = split_plot_anova(values[:6], groups[:6])
    means = 0.5 * (values[:4].mean(axis=0) + values[4:6].mean(axis=0))
    weight = 4.0 / (1.0 / 4.0 + 1.0 / 2.0)
    assert uneven.within.ss == pytest.approx(weight * np.square(means - means.mean()).sum())


def test_data_without_error_variance_are_rejected() -> None:
    """Data in which all subjects differ equally are rejected, since there is no error term."""
    values = np.arange(5.0)[:, np.newaxis] + [0.0, 1.0, 3.0]
    with pytest.raises(ConstantData, match="same amount"):
        rm_anova(values)
    with pytest.raises(TooFewData, match="at least 2"):
        rm_anova(values[:1])
    with pytest.raises(StatisticsError, match="missing"):
        rm_anova([[1.0, np.nan], [2.0, 3.0]])
    with pytest.raises(TooFewData, match="a 4, b 1"):
        split_plot_anova(values, ["a", "a", "a", "a", "b"])
