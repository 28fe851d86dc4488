"""Tests of power by simulation against published power, and of what is said beside it."""

import numpy as np
import pytest

from app.science.pilot import (
    PowerPoint,
    Results,
    power_point,
    smallest_sufficient,
)
from app.science.statistics import (
    Expected,
    StatisticsError,
    clopper_pearson,
    rm_anova_power,
)
from tests.science.pilot.known_powers import (
    PUBLISHED,
    SETS,
    greenhouse_geisser,
    simulated_power,
)


@pytest.mark.parametrize(("n", "eta", "published"), PUBLISHED)
def test_power_of_the_anova_is_the_published_one(n: int, eta: float, published: float) -> None:
    """G*Power 3's power of the rm ANOVA, m = 3, r = .5: simulated within 2 SE, level 5 %, too."""
    assert rm_anova_power(n, Expected(eta)) == pytest.approx(published, abs=0.0005)
    point = simulated_power(n, eta, seed=24)
    assert point.power == pytest.approx(published, abs=2 * np.sqrt(published * 0.18 / SETS))
    assert point.low < published < point.high
    assert point.level == pytest.approx(0.05, abs=2 * np.sqrt(0.05 * 0.95 / SETS))
    assert point.mean_estimate == pytest.approx(2 * np.sqrt(1.5 * eta / (1 - eta)), rel=0.05)


def test_the_corrected_test_has_less_power_under_sphericity() -> None:
    """Greenhouse-Geisser costs power where nothing needs correcting, and keeps below 5 %."""
    plain = simulated_power(12, 0.14, 24)
    corrected = simulated_power(12, 0.14, 24, greenhouse_geisser)
    assert 0.01 < plain.power - corrected.power < 0.06
    assert corrected.level <= plain.level


def test_type_s_and_type_m_count_significant_results_only() -> None:
    """Of three significant results, one has the wrong sign; their mean size is twice the truth."""
    tested = Results(
        np.array([True, True, True, False, False]),
        np.array([False, False, False, False, True]),
        np.array([-2.0, -3.0, 1.0, 50.0, np.nan]),
        np.array([12, 12, 12, 12, 0]),
    )
    point = power_point(12, tested, tested, assumed=-1.0)
    assert point.type_s == pytest.approx(1 / 3)
    assert point.type_m == 2.0
    assert (point.power, point.failures, point.sets) == (0.6, 1, 5)
    assert point.mean_in_test == pytest.approx(9.6)


def test_a_failed_test_rejects_nothing() -> None:
    """A test that could not be computed counts as a data set that is not significant."""
    failed = Results(
        np.ones(4, np.bool_), np.ones(4, np.bool_), np.full(4, np.nan), np.zeros(4, np.int64)
    )
    point = power_point(2, failed, failed, assumed=1.0)
    assert (point.power, point.low, point.failures) == (0.0, 0.0, 4)
    assert (point.type_s, point.mean_estimate) == (None, None)


def test_the_smallest_number_is_judged_by_the_lower_bound() -> None:
    """A number whose power reaches the target by luck alone is not sufficient."""
    points = [_of(n, share) for n, share in ((10, 0.75), (12, 0.82), (16, 0.9), (20, 0.88))]
    assert points[1].power > 0.8 > points[1].low
    assert smallest_sufficient(points, 0.8) == 16
    assert smallest_sufficient(points, 0.95) is None


def _of(n: int, share: float) -> PowerPoint:
    significant = np.arange(200) < share * 200
    tested = Results(significant, np.zeros(200, np.bool_), np.ones(200), np.full(200, n))
    return power_point(n, tested, tested, assumed=1.0)


@pytest.mark.parametrize(
    ("x", "m", "low", "high"),
    # R 4, binom.test(x, m)$conf.int; 0 of 10 is 1 - .025^(1/10) by hand.
    [(5, 10, 0.1870860, 0.8129140), (0, 10, 0.0, 0.3084971), (10, 10, 0.6915029, 1.0)],
)
def test_bands_are_those_of_clopper_and_pearson(x: int, m: int, low: float, high: float) -> None:
    """The exact interval of a proportion is that of R's binom.test."""
    assert clopper_pearson(x, m) == pytest.approx((low, high), abs=5e-8)


def test_bands_of_the_default_are_within_the_promise() -> None:
    """A thousand data sets leave power uncertain by less than 8 points, wherever it is."""
    for significant in range(0, 1001, 50):
        low, high = clopper_pearson(significant, 1000)
        assert significant / 1000 - low < 0.08
        assert high - significant / 1000 < 0.08


@pytest.mark.parametrize(("x", "m", "confidence"), [(1, 0, 0.95), (5, 4, 0.95), (1, 4, 1.0)])
def test_no_proportion_is_refused(x: int, m: int, confidence: float) -> None:
    """More successes than trials, no trials and a certain interval are refused."""
    with pytest.raises(StatisticsError):
        clopper_pearson(x, m, confidence=confidence)
