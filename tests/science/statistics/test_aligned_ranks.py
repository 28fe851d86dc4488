"""Tests of aligned ranks: the effects that alignment keeps or removes, and contrasts."""

import numpy as np
import pytest

from app.science.statistics import (
    StatisticsError,
    aligned_contrasts,
    aligned_ranks_split_plot,
    aligned_ranks_within,
    rm_anova,
)
from app.science.statistics.arrays import midranks


def test_with_one_factor_ranks_are_those_of_the_values() -> None:
    """With one factor the test is an analysis of variance of the plain ranks."""
    values = np.random.default_rng(1).normal(size=(8, 3))
    ranks = midranks(values.ravel()).reshape(values.shape)
    assert aligned_ranks_within(values).effects[0].f == pytest.approx(rm_anova(ranks).effects[0].f)


def test_an_effect_of_one_factor_leaves_the_others_alone() -> None:
    """A growing effect of latency does not change the tests of limb and interaction."""
    rng = np.random.default_rng(2)
    values = rng.normal(size=(10, 3, 2))
    large = values + np.array([0.0, 50.0, 900.0])[:, np.newaxis]
    before = aligned_ranks_within(values, ("latency", "limb")).effects
    after = aligned_ranks_within(large, ("latency", "limb")).effects
    for one, other in list(zip(before, after, strict=True))[1:]:
        assert other.f == pytest.approx(one.f, rel=1e-6)
    assert after[0].f > 10.0 * before[0].f


def test_every_result_says_that_the_method_is_contested() -> None:
    """Every result of aligned ranks notes that the method is contested."""
    values = np.random.default_rng(3).normal(size=(6, 3))
    results = (
        aligned_ranks_within(values),
        aligned_ranks_split_plot(values, list("aaabbb")),
        aligned_contrasts(values, [["0", "125", "350"]], [1]),
    )
    assert all(result.caution.startswith("contested") for result in results)


def test_contrasts_are_of_the_ranks_aligned_for_their_factor() -> None:
    """A contrast of two levels has t squared equal to F; contrasts of all cells use plain ranks."""
    rng = np.random.default_rng(4)
    values = rng.normal(size=(9, 2, 2))
    levels = [["0", "350"], ["hand", "foot"]]
    one = aligned_contrasts(values[:, :, 0], levels[:1], [1]).contrasts
    plain = aligned_ranks_within(values[:, :, 0]).effects[0]
    assert len(one) == 1
    assert one[0].t ** 2 == pytest.approx(plain.f)
    assert one[0].p == pytest.approx(plain.p)
    joint = aligned_contrasts(values, levels, [1, 2]).contrasts
    means = midranks(values.ravel()).reshape(values.shape).mean(axis=0)
    assert len(joint) == 6
    assert (joint[0].a, joint[0].b) == (("0", "hand"), ("0", "foot"))
    assert joint[0].estimate == pytest.approx(means[0, 0] - means[0, 1])
    assert joint[0].df == 8 * 3
    assert all(pair.p_holm >= pair.p for pair in joint)
    main = aligned_contrasts(values, levels, [2]).contrasts
    assert [(pair.a, pair.b) for pair in main] == [(("hand",), ("foot",))]


def test_unknown_axes_are_rejected() -> None:
    """The error about an unknown axis, or axis 0 of the subjects, names the valid ones."""
    with pytest.raises(StatisticsError, match="1 to 1"):
        aligned_contrasts(np.ones((3, 2)), [["a", "b"]], [0])
