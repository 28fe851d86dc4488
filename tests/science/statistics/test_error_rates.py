"""Tests of simulated data sets without effects, and of the table of the tests' error rates."""

import json
from pathlib import Path

import numpy as np
import pytest

from app.science.statistics.error_rates import ErrorRate, ErrorRates, error_rates_from_json
from tests.benchmarks.error_rates import PAGE, TABLE, page
from tests.benchmarks.null_data import NullDesign, null_data, population_alpha
from tests.benchmarks.null_tests import ABOUT, GROUPS


def row(rate: float, kind: str = "rejection", *, exact: bool = False) -> ErrorRate:
    """Return a row of the table for 2,000 data sets."""
    made = {"participants": 0, "sets": 2000, "failed": 0, "rate": rate, "exact": exact}
    text = {"test": "friedman_exact", "scenario": "level", "measure": "item", "kind": kind}
    stored = {"seed": 1, "design": {}, "rows": [text | made]}
    (found,) = error_rates_from_json(json.dumps(stored)).rows
    return found


@pytest.fixture(scope="module")
def shipped() -> ErrorRates:
    """Return the error rates that are shipped with the product."""
    return error_rates_from_json(Path(TABLE).read_text(encoding="utf-8"))


def test_the_same_seed_gives_the_same_data() -> None:
    """The same seed gives the same data sets."""
    one, other = (null_data(NullDesign(12), np.random.default_rng(4)) for _ in range(2))
    assert np.array_equal(one.measure, other.measure)
    assert np.array_equal(one.item, other.item)
    assert one.measure.shape == one.item.shape == (12, 3, 2)


def test_the_data_sets_have_no_effects() -> None:
    """Over many participants all latencies and limbs have equal means and deviations."""
    data = null_data(NullDesign(60_000, reaction=0.8), np.random.default_rng(1))
    for values in (data.measure, data.item.astype(float)):
        assert np.ptp(values.mean(axis=(0, 2))) < 0.03
        assert np.ptp(values.mean(axis=(0, 1))) < 0.03
        assert np.ptp(values.std(axis=(0, 2))) < 0.03


def test_reactions_make_far_latencies_less_alike() -> None:
    """With reactions 350 ms correlates less with 0 ms than 125 ms does; without, equally."""
    for reaction in (0.0, 0.8):
        data = null_data(NullDesign(30_000, reaction=reaction), np.random.default_rng(7))
        alike = np.array(np.corrcoef(data.measure[:, :, 0], rowvar=False))
        assert alike[0, 1] - alike[0, 2] == pytest.approx(0.2 if reaction else 0.0, abs=0.02)


def test_items_are_answered_as_people_answer() -> None:
    """Simulated answers use the whole scale from 1 to 7, mostly agree, and often repeat."""
    data = null_data(NullDesign(6000), np.random.default_rng(2))
    shares = np.bincount(data.item.ravel(), minlength=8)[1:] / data.item.size
    assert shares.min() > 0.01
    assert shares[4:].sum() > 0.6
    ties = (data.item[:, 0, 0] == data.item[:, 2, 0]).mean()
    assert ties > 0.25


def test_orders_are_complete_blocks() -> None:
    """Each latency occurs equally often in each period."""
    periods = null_data(NullDesign(18), np.random.default_rng(3)).periods
    for latency in range(3):
        assert np.bincount(periods[:, latency]).tolist() == [0, 6, 6, 6]
    with pytest.raises(ValueError, match="13 participants"):
        null_data(NullDesign(13), np.random.default_rng(3))


def test_alpha_of_the_population_follows_from_the_levels() -> None:
    """Without differences between participants' levels, the population's alpha is zero."""
    assert population_alpha(NullDesign(0, level_sd=0.0), np.random.default_rng(5)) == pytest.approx(
        0.0, abs=0.01
    )
    assert population_alpha(NullDesign(0), np.random.default_rng(5)) > 0.6


@pytest.mark.parametrize(
    ("rate", "kind", "warning"),
    [
        (0.05, "rejection", ""),
        (0.066, "rejection", "rejects_too_often"),
        (0.039, "rejection", "rejects_too_seldom"),
        (0.934, "coverage", "covers_too_seldom"),
        (0.97, "coverage", ""),
    ],
)
def test_a_page_warns_out_of_bounds(rate: float, kind: str, warning: str) -> None:
    """Error rates outside of 4 to 6.5 % and interval coverages below 93.5 % get a warning."""
    assert row(rate, kind).warning == warning


def test_an_exact_test_that_rejects_too_often_breaks_its_promise() -> None:
    """An exact test is within its guarantee up to three standard errors above 5 %."""
    assert row(0.064, exact=True).is_within_guarantee
    assert not row(0.065, exact=True).is_within_guarantee


def test_exact_tests_keep_their_promise(shipped: ErrorRates) -> None:
    """No exact test of the shipped table rejects beyond 5 % and three standard errors."""
    exact = [one for one in shipped.rows if one.exact]
    assert {one.test for one in exact} == {name for name, about in ABOUT.items() if about.exact}
    assert [one for one in exact if not one.is_within_guarantee] == []


def test_every_test_was_tried_on_two_thousand_data_sets(shipped: ErrorRates) -> None:
    """Every row of the shipped table has two thousand data sets, of which hardly any failed."""
    for name in ABOUT:
        found = shipped.of(name)
        assert found is not None
        assert found.sets + found.failed >= 2000
        assert found.failed <= 0.01 * found.sets


def test_a_study_is_judged_by_data_sets_of_its_size(shipped: ErrorRates) -> None:
    """A study gets the row of the nearest number of participants; an unknown test has none."""
    for participants, nearest in ((11, 12), (16, 18), (40, 24)):
        found = shipped.near("clmm_laplace", participants)
        assert found is not None
        assert found.participants == nearest
    assert shipped.near("tea_leaves", 12) is None


def test_the_page_of_the_documents_is_that_of_the_table(shipped: ErrorRates) -> None:
    """The page of the documentation equals the page generated from the table."""
    assert Path(PAGE).read_text(encoding="utf-8") == page(shipped)


@pytest.mark.parametrize("group", GROUPS)
def test_every_group_of_tests_can_be_computed(group: str) -> None:
    """Every group of tests runs on one data set, and all its names are in the table of tests."""
    rng = np.random.default_rng(6)
    outcomes = dict(GROUPS[group](null_data(NullDesign(12), rng), 0.66, rng))
    assert outcomes
    assert set(outcomes) <= set(ABOUT)
    assert None not in outcomes.values()
