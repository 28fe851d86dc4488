"""Tests of cutting the path of a hand into reaches."""

from dataclasses import replace

import numpy as np
import pytest

from app.science.reaching import (
    HandTrack,
    Reacher,
    ReachingError,
    ReachRules,
    cut_agents,
    reaches_of,
)
from app.science.rotations import FloatArray
from app.science.simulation import skewed_jerk
from tests.science.reaching.reachers import RATE_HZ, STILL_M_S, Planted, hand_of

WHO = Reacher("P1", "first.csv")


def track_of(positions_m: FloatArray, trunk_m: FloatArray | None = None) -> HandTrack:
    """Return the track of a hand at the rate of a headset."""
    return HandTrack(np.arange(len(positions_m)) / RATE_HZ, positions_m, "right", WHO, trunk_m)


def one_reach(
    lasts_s: float = 0.8, distance_m: float = 0.4, rest_s: float = 0.5, aside_m: float = 0.0
) -> FloatArray:
    """Return the path (N, 3) of one movement between two rests, with an arc to the side."""
    rest, moving = round(rest_s * RATE_HZ), round(lasts_s * RATE_HZ)
    shares = [skewed_jerk(at / moving, 1.0) for at in range(moving)]
    whole = np.array([0.0] * rest + shares + [1.0] * rest)
    return np.stack(
        [distance_m * whole, aside_m * np.sin(np.pi * whole), np.zeros(len(whole))], axis=-1
    )


def reasons(track: HandTrack) -> list[str]:
    """Return why the movements of a track are no reaches; there must be none."""
    reaches, left_out = reaches_of(track)
    assert reaches == []
    return [one.reason for one in left_out]


def test_a_movement_between_rests_is_a_reach_of_its_distance_and_cut_time() -> None:
    """What the agent's cut says of a planted movement is what is found of it."""
    (reach,), left_out = reaches_of(track_of(one_reach()))
    agent = cut_agents(reach.distance_m, np.array([0.8]), np.ones(1), STILL_M_S)
    assert left_out == []
    assert reach.duration_s == pytest.approx(float(agent.arrival_s[0]), abs=0.015)
    assert reach.distance_m == pytest.approx(0.4, abs=0.01)
    assert reach.straightness > 0.999
    assert reach.peak_share == pytest.approx(0.5, abs=0.03)


def test_every_planted_reach_is_found() -> None:
    """A hand that goes to and fro twenty times makes twenty reaches."""
    track = hand_of(Planted(1.0), WHO, np.random.default_rng(1), count=20)
    reaches, left_out = reaches_of(track)
    assert (len(reaches), left_out) == (20, [])


@pytest.mark.parametrize(
    ("positions_m", "said"),
    [
        (one_reach(distance_m=0.07), "less than 0.1 m apart"),
        (one_reach(distance_m=1.4), "farther than an arm"),
        (one_reach(lasts_s=9.0, distance_m=0.9), "more than 3 s"),
        (one_reach(aside_m=0.4), "detour"),
        (one_reach()[60:], "begins or ends during it"),
    ],
)
def test_what_is_no_reach_is_named_with_its_reason(positions_m: FloatArray, said: str) -> None:
    """Each movement that is left out says why."""
    (reason,) = reasons(track_of(positions_m))
    assert said in reason


def test_a_movement_while_the_person_walks_is_no_reach() -> None:
    """A hand that is carried along with the head does not reach."""
    path = one_reach()
    (reason,) = reasons(track_of(path, path + 0.5))
    assert "the person walks" in reason
    assert len(reaches_of(track_of(path, np.zeros_like(path)))[0]) == 1


def test_a_reach_in_which_the_hand_was_not_seen_is_cut_by_the_recording() -> None:
    """A tenth of a second out of sight is bridged; longer, the movement is in no one piece."""
    path = one_reach()
    middle = len(path) // 2
    path[middle : middle + 5] = np.nan
    assert len(reaches_of(track_of(path))[0]) == 1
    path[middle - 15 : middle + 15] = np.nan
    assert all("out of sight" in reason for reason in reasons(track_of(path)))


def test_a_hand_at_rest_makes_no_movements() -> None:
    """Noise of a tracker is neither a reach nor left out."""
    still = 0.0002 * np.random.default_rng(1).standard_normal((900, 3))
    assert reaches_of(track_of(still)) == ([], [])


def test_bad_rules_and_tracks_are_refused_with_what_is_valid() -> None:
    """The messages name the value and what to give instead."""
    with pytest.raises(ReachingError, match=r"still_m_s is -1\.0; it must be positive"):
        ReachRules(still_m_s=-1.0)
    with pytest.raises(ReachingError, match=r"times of first.csv, right do not increase"):
        replace(track_of(one_reach()), times_s=np.zeros(len(one_reach())))
    with pytest.raises(ReachingError, match=r"20\.0 m wide: give metres"):
        Reacher("P1", "first.csv", width_m=20.0)
