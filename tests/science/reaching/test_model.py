"""Tests of fitting how people reach, and of the people that are drawn from it."""

from collections.abc import Sequence
from functools import cache

import numpy as np
import pytest

from app.science.reaching import (
    DIFFICULTY,
    DISTANCE,
    FittedReaching,
    Reach,
    Reacher,
    ReachFitOptions,
    ReachingError,
    ReachRules,
    fitted_reaching,
    levels_of,
    reach_database,
    reaches_of,
)
from app.science.rotations import FloatArray
from app.science.simulation import TEMPO_SPREAD, usual_time_s
from tests.science.reaching.reachers import NEAR_M, Planted, hand_of

FEW = ReachFitOptions(entries=400, k=160)
TEMPOS = (0.9, 1.0, 1.1, 1.25, 1.3, 1.4, 1.6, 1.8)


def reaches_by(
    tempos: Sequence[float], count: int = 15, *, width_m: float | None = None, skew: float = 1.0
) -> list[Reach]:
    """Return the reaches of people with these tempos."""
    found: list[Reach] = []
    for at, tempo in enumerate(tempos):
        who = Reacher(f"P{at}", f"{at}.csv", "synthetic", width_m)
        rng = np.random.default_rng((7, at))
        found += reaches_of(hand_of(Planted(tempo, skew=skew), who, rng, count=count))[0]
    return found


def fit_to(reaches: Sequence[Reach]) -> FittedReaching:
    """Fit a small model."""
    rules = ReachRules()
    return fitted_reaching(reach_database(reaches, rules)[0], rules, FEW)


@cache
def planted() -> FittedReaching:
    """Return the model of eight planted people."""
    return fit_to(reaches_by(TEMPOS))


def medians_s(fit: FittedReaching, distance_m: float, near_m: float = NEAR_M) -> float:
    """Return the median whole time of new people."""
    return float(np.median(fit.movements(distance_m, near_m, 4000, np.random.default_rng(1))[0]))


def test_planted_tempos_are_recovered() -> None:
    """Each person's level is their planted tempo within 6 %, and the interval holds the median."""
    levels = planted().levels
    assert np.exp(levels.logs) == pytest.approx(np.array(TEMPOS), rel=0.06)
    low, high = levels.interval()
    assert low < float(np.exp(np.mean(np.log(TEMPOS)))) < high


def test_predicted_times_are_those_of_the_planted_people() -> None:
    """New people take the planted median time at any recorded distance, within 8 %."""
    tempo = float(np.exp(np.mean(np.log(TEMPOS))))
    for distance_m in (0.2, 0.4, 0.65):
        expected_s = tempo * usual_time_s(distance_m, NEAR_M)
        assert medians_s(planted(), distance_m) == pytest.approx(expected_s, rel=0.08)


def test_planted_skew_is_recovered_in_its_direction() -> None:
    """People who are fastest early are told from those who are fastest late."""
    rng = np.random.default_rng(1)
    early, late = (
        np.median(fit_to(reaches_by((1.0, 1.3), skew=skew)).movements(0.4, NEAR_M, 2000, rng)[1])
        for skew in (1.7, 0.65)
    )
    assert late < 0.9 < 1.1 < early


def test_one_persons_movements_differ_less_than_peoples() -> None:
    """A drawn person keeps their level; between people there is more."""
    rng = np.random.default_rng(3)
    people = [planted().person(rng) for _ in range(400)]
    logs = np.log([[one.movement(0.4, NEAR_M, rng)[0] for _ in range(20)] for one in people])
    within, between = logs.std(axis=1).mean(), logs.mean(axis=1).std()
    assert within < between
    # The planted spreads are 8 % within, and 23 % between; a map is wider than its reach.
    assert 0.07 < within < 0.17
    # Student's t with 10 degrees of freedom, around a mean that eight people leave open.
    expected = planted().levels.spread * np.sqrt((1.0 + 1.0 / 8.0) * 10.0 / 8.0)
    assert between == pytest.approx(expected, rel=0.15)


def test_more_reaches_of_the_same_people_do_not_make_more_people() -> None:
    """Four times as many reaches of two people leave the interval as wide, or nearly."""
    few, many = (fit_to(reaches_by((1.0, 1.4), count)).levels for count in (10, 40))
    widths = [np.log(high / low) for low, high in (one.interval() for one in (few, many))]
    assert widths[1] > 0.8 * widths[0]
    assert many.freedom == few.freedom


def test_of_one_person_the_assumed_spread_is_all_there_is() -> None:
    """How people differ cannot be learnt from one: the simulation's assumed SD takes its place."""
    levels = fit_to(reaches_by((1.3,))).levels
    assert levels.spread == pytest.approx(TEMPO_SPREAD)
    assert np.exp(levels.mean) == pytest.approx(1.3, rel=0.06)


def test_levels_are_compared_at_the_same_distance() -> None:
    """Somebody recorded over long distances only has no other level for that."""
    far = np.array([0.2, 0.3, 0.4, 0.5, 0.6, 0.7])
    logs = 0.1 + 0.5 * np.log(far)
    levels = levels_of(logs, far, ("near",) * 3 + ("far",) * 3)
    assert levels.slope == pytest.approx(0.5)
    assert levels.logs[0] == pytest.approx(levels.logs[1])


def test_the_same_seed_gives_the_same_people_and_movements() -> None:
    """Fitting and drawing are reproducible to the last bit."""
    again = fit_to(reaches_by(TEMPOS))
    one, other = (
        [person.movement(0.3, NEAR_M, rng) for _ in range(20)]
        for rng, person in (
            (rng, fit.person(rng))
            for fit, rng in (
                (planted(), np.random.default_rng(5)),
                (again, np.random.default_rng(5)),
            )
        )
    )
    assert one == other


def test_movements_outside_of_the_recorded_distances_are_counted() -> None:
    """A person knows how many of their movements nobody recorded the like of."""
    rng = np.random.default_rng(1)
    person = planted().person(rng)
    for distance_m in (0.3, 0.4, 2.0):
        person.movement(distance_m, NEAR_M, rng)
    assert person.counts == (3, 1)


def test_without_widths_difficulty_does_not_matter_and_with_them_it_does() -> None:
    """A smaller target takes longer only if the recorded targets' widths are known."""
    assert planted().database.names == (DISTANCE,)
    assert medians_s(planted(), 0.4, 0.01) == medians_s(planted(), 0.4, 0.05)
    wide, narrow = (reaches_by((1.0, 1.2), width_m=width_m) for width_m in (0.2, 0.02))
    known = fit_to(wide + narrow)
    assert known.database.names == (DISTANCE, DIFFICULTY)
    assert medians_s(known, 0.4, 0.01) > 1.3 * medians_s(known, 0.4, 0.1)


def test_a_reach_beyond_the_agents_tempos_is_left_out_with_its_reason() -> None:
    """Somebody who takes far longer than any agent is named, not fitted."""
    slow = reaches_by((1.0,), 8)
    ends = slow[0].positions_m[[0, -1]]
    times_s: FloatArray = np.linspace(0.0, 30.0, 500)
    shares = np.linspace(0.0, 1.0, 500)[:, None]
    path = ends[0] + shares * (ends[1] - ends[0])
    _, left_out = reach_database([*slow, Reach(times_s, path, "right", slow[0].who)], ReachRules())
    assert ["beyond the agent's tempos" in one.reason for one in left_out] == [True]


def test_too_few_reaches_are_refused_with_what_a_reach_is() -> None:
    """Three reaches are too few, and the message says how many are needed."""
    with pytest.raises(ReachingError, match="There are 3 reaches; at least 5 are needed"):
        reach_database(reaches_by((1.0,), 3), ReachRules())
