"""Tests of predicting the reaches of people who were left out."""

from dataclasses import replace

import numpy as np
import pytest

from app.science.reaching import ReachingError, ReachRules, evaluate_reaching, reach_database
from app.science.reaching.evaluation import near_of
from tests.science.reaching.test_model import fit_to, reaches_by


def test_slow_people_are_predicted_better_by_maps_than_by_the_assumed_constants() -> None:
    """People of twice the assumed time are foreseen from others like them."""
    found = evaluate_reaching(fit_to(reaches_by((1.8, 1.9, 2.0, 2.1, 2.2, 2.0), 8)), draws=100)
    maps, assumed = found.score("maps"), found.score("assumed")
    assert (found.left_out, found.groups, found.no_interval) == ("people", 6, None)
    assert maps.crps_s < 0.5 * assumed.crps_s
    assert assumed.interval_s is not None
    assert assumed.interval_s[0] > 0.0
    assert "not by chance" in found.verdict


def test_people_like_the_assumed_ones_are_predicted_about_as_well_by_them() -> None:
    """Where the constants are right, the maps are little worse: they have to learn them."""
    found = evaluate_reaching(fit_to(reaches_by((0.85, 0.95, 1.0, 1.05, 1.15, 1.1), 8)), draws=100)
    assert found.score("maps").crps_s < 1.25 * found.score("assumed").crps_s


def test_with_few_people_no_interval_is_given() -> None:
    """Three people cannot say whether a difference is chance, and the result says so."""
    found = evaluate_reaching(fit_to(reaches_by((1.0, 1.5, 1.3), 6)), draws=50)
    assert found.no_interval is not None
    assert found.score("line").interval_s is None
    assert "too few to say" in found.verdict


def test_one_person_in_several_recordings_is_evaluated_by_recording() -> None:
    """Recordings take the place of people, and the verdict says so."""
    fit = fit_to(reaches_by((1.2, 1.2, 1.2), 6))
    together = replace(fit.database, subjects=("P",) * len(fit.database))
    one = replace(fit, database=together)
    found = evaluate_reaching(one, draws=50)
    assert (found.left_out, found.groups) == ("recordings", 3)
    assert "says little about others" in found.verdict


def test_a_single_recording_has_nothing_to_leave_out() -> None:
    """The message says what is needed instead."""
    with pytest.raises(ReachingError, match="of 1 people in 1 recordings: to leave one out"):
        evaluate_reaching(fit_to(reaches_by((1.0,), 8)))


def test_a_known_width_is_found_again_in_the_tables() -> None:
    """Half a target's width follows from distance and difficulty."""
    known, _ = reach_database(reaches_by((1.0,), 6, width_m=0.04), ReachRules())
    unknown, _ = reach_database(reaches_by((1.0,), 6), ReachRules())
    assert near_of(known.select(np.array([2]))) == pytest.approx(0.02)
    assert near_of(unknown.select(np.array([2]))) == pytest.approx(0.05)
