"""Tests of a latency study's planned comparisons, shares, correlations and demographics."""

import math

import numpy as np
import pytest
from scipy import stats

from app.science.statistics import (
    ConstantData,
    StatisticsError,
    TooFewData,
    against_reference,
    contact_shares,
    directional,
    explore,
    share_of_maximum,
    spearman,
)

_LEVELS = ("0", "125", "350")
#: Agency of ten people that falls at 350 ms only.
_AGENCY = np.array(
    [(9, 9, 4), (8, 9, 3), (10, 9, 5), (7, 7, 2), (11, 10, 6), (6, 7, 1), (9, 8, 2), (12, 11, 7),
     (5, 6, 0), (8, 8, 4)],
    dtype=np.float64,
)  # fmt: skip


def test_the_first_latency_that_differs() -> None:
    """The first latency that differs from 0 ms is found, adjusted for two comparisons."""
    found = against_reference(_AGENCY, _LEVELS, "0")
    assert [(one.a, one.b) for one in found.comparisons] == [("125", "0"), ("350", "0")]
    assert found.first_that_differs == "350"
    assert found.comparisons[1].test.rank_biserial == -1.0
    assert found.comparisons[1].p_holm == pytest.approx(2.0 * 2.0 / 2**10)
    nothing = against_reference(_AGENCY[:, [0, 1, 0]] + [0.0, 0.0, 0.5], _LEVELS, "0", alpha=0.001)
    assert nothing.first_that_differs is None


def test_a_predicted_fall_is_tested_one_sided() -> None:
    """A predicted fall is tested one-sided; it is supported as a fall and not as a rise."""
    falls = directional(_AGENCY, _LEVELS, "falls")
    rises = directional(_AGENCY, _LEVELS, "rises")
    assert falls.supported
    assert not rises.supported
    assert falls.p < 0.001 < 0.99 < rises.p
    assert falls.against_first.alternative == "less"
    assert falls.against_first.comparisons[1].test.p == pytest.approx(1.0 / 2**10)
    with pytest.raises(StatisticsError, match="rises, falls"):
        directional(_AGENCY, _LEVELS, "drops")  # type: ignore[arg-type]  # no such word


def test_a_subject_without_a_level_counts_in_the_other_comparisons() -> None:
    """A subject without a level is left out of the trend but not of the other comparisons."""
    values = _AGENCY.copy()
    values[0, 2] = math.nan
    found = directional(values, _LEVELS, "falls")
    assert found.n_left_out == 1
    assert [one.test.n for one in found.against_first.comparisons] == [10, 9]


def test_components_side_by_side_are_shares_of_their_maxima() -> None:
    """Components are shares of their maxima: 8 of 15, 7 of 12 (Karas 2020, table 7.2)."""
    assert share_of_maximum([8.0, math.nan, -15.0], 15.0)[[0, 2]] == pytest.approx([8 / 15, -1.0])
    assert share_of_maximum(7.0, 12.0) == pytest.approx(7 / 12)
    with pytest.raises(StatisticsError, match=r"16\.0 is beyond the maximum of 15"):
        share_of_maximum([3.0, 16.0], 15.0)
    with pytest.raises(StatisticsError, match="positive"):
        share_of_maximum([3.0], 0.0)


def test_contact_time_divides_among_finger_hand_and_arm() -> None:
    """A subject's contact shares add up to 1; without any contact they are missing."""
    times = {
        "RightIndexDistal": [3.0, 0.0],
        "RightThumbDistal": [1.0, 0.0],
        "RightHand": [4.0, 0.0],
        "RightLowerArm": [2.0, 0.0],
    }
    groups = {
        "RightIndexDistal": "finger",
        "RightThumbDistal": "finger",
        "RightHand": "hand",
        "RightLowerArm": "arm",
    }
    found = contact_shares(times, groups)
    assert found.groups == ("finger", "hand", "arm")
    assert found.shares[0] == pytest.approx([0.4, 0.4, 0.2])
    assert np.isnan(found.shares[1]).all()
    assert (found.total_s.tolist(), found.n_without_contact) == ([10.0, 0.0], 1)


def test_impossible_contact_times_are_rejected() -> None:
    """An unknown part, a negative time, unequal lengths and empty data are rejected."""
    with pytest.raises(StatisticsError, match="No group was given for Head"):
        contact_shares({"Head": [1.0]}, {})
    with pytest.raises(StatisticsError, match="Head: give one time"):
        contact_shares({"Head": [-1.0]}, {"Head": "head"})
    with pytest.raises(StatisticsError, match="different numbers"):
        contact_shares({"Head": [1.0], "Neck": [1.0, 2.0]}, {"Head": "h", "Neck": "h"})
    with pytest.raises(StatisticsError, match="No body part"):
        contact_shares({}, {})


def test_rank_correlation_is_that_of_scipy() -> None:
    """Rank correlation with ties and a missing pair is scipy's, and its interval includes rho."""
    rng = np.random.default_rng(5)
    x = rng.integers(1, 8, 12).astype(np.float64)
    y = x + rng.normal(0.0, 2.0, 12)
    found = spearman(np.append(x, math.nan), np.append(y, 1.0))
    theirs = stats.spearmanr(x, y)
    assert found.rho == pytest.approx(theirs.statistic)
    assert found.p == pytest.approx(theirs.pvalue)
    assert found.low < found.rho < found.high
    assert (found.n, found.n_left_out) == (12, 1)


def test_rank_correlation_knows_its_limits() -> None:
    """Monotone relations give 1 or -1; constant data and only three pairs are rejected."""
    x = np.arange(6.0)
    assert spearman(x, np.exp(x)).rho == 1.0
    assert spearman(x, -(x**3)).rho == -1.0
    with pytest.raises(ConstantData, match="same in all 6"):
        spearman(x, np.ones(6))
    with pytest.raises(TooFewData, match="3 pairs"):
        spearman(x[:3], x[:3])


def test_demographics_are_explored_and_say_so() -> None:
    """Demographics are labelled exploratory and adjusted together.

    Numbers use Spearman's correlation, categories the Kruskal-Wallis test.
    """
    scores = np.array([1.0, 3.0, 2.0, 5.0, 4.0, 6.0, 6.0, math.nan])
    age = [20.0, 25.0, 22.0, 31.0, 29.0, 40.0, math.nan, 30.0]
    sex = ["f", "m", "f", "m", "f", "m", None, "f"]
    found = explore(scores, {"age": age, "height": [1.7] * 8}, {"sex": sex})
    by_name = {one.variable: one for one in found}
    assert {one.label for one in found} == {"exploratory"}
    assert (by_name["age"].effect, by_name["age"].n, by_name["age"].n_left_out) == (1.0, 6, 2)
    kruskal = stats.kruskal([1.0, 2.0, 4.0], [3.0, 5.0, 6.0])
    assert by_name["sex"].p == pytest.approx(kruskal.pvalue)
    assert by_name["sex"].p_holm == pytest.approx(kruskal.pvalue)
    assert math.isnan(by_name["height"].p)
    assert "same in all" in by_name["height"].why_not
