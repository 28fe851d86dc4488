"""Tests of the agent that reaches, and of the map of a single reach."""

from dataclasses import replace

import numpy as np
import pytest

from app.science.reaching import REACH_GRID, Reach, cut_agents, map_of
from app.science.reaching.database import best_log_tempo
from app.science.rotations import FloatArray
from app.science.simulation import skewed_jerk, usual_time_s
from app.science.walking.maps import PAPER, TIME_AWARE, SuitabilityOptions
from tests.science.reaching.reachers import NEAR_M, STILL_M_S, reach_of_the_agent

NODES = [(14, 2), (20, 3), (20, 6), (27, 0), (31, 5)]
"""Some combinations of tempo and skew, by their places on the grid."""


def of_node(node: tuple[int, int]) -> Reach:
    """Return the reach of the agent with the parameters of a node."""
    tempo, skew = (np.exp(REACH_GRID.values[axis][at]) for axis, at in enumerate(node))
    return reach_of_the_agent(float(tempo), float(skew))


def turned(reach: Reach, about: FloatArray, shift_m: FloatArray) -> Reach:
    """Return a reach turned by a rotation vector, and moved."""
    from scipy.spatial.transform import Rotation

    return replace(
        reach, positions_m=Rotation.from_rotvec(about).apply(reach.positions_m) + shift_m
    )


@pytest.mark.parametrize("node", NODES)
@pytest.mark.parametrize("reading", [PAPER, TIME_AWARE])
def test_the_map_of_the_agents_own_reach_is_highest_at_its_own_parameters(
    node: tuple[int, int], reading: SuitabilityOptions
) -> None:
    """Nothing else is as suitable to repeat a reach as what made it."""
    found = map_of(of_node(node), STILL_M_S)
    best = np.unravel_index(int(np.argmax(found.read(reading).values)), found.grid.shape)
    assert tuple(int(at) for at in best) == node
    assert found.deviations[node] < 1e-3
    assert found.arrival_s[node] == pytest.approx(found.reference_s, rel=1e-3)


@pytest.mark.parametrize("node", NODES)
def test_the_best_tempo_of_the_agents_own_reach_is_its_own(node: tuple[int, int]) -> None:
    """The tempo that is read from a map, between its nodes, is the one that was simulated."""
    found = best_log_tempo(map_of(of_node(node), STILL_M_S))
    assert found == pytest.approx(REACH_GRID.values[0][node[0]], abs=0.01)


def test_a_map_depends_neither_on_place_nor_on_direction() -> None:
    """The same reach elsewhere in the room, to any side, has the same map."""
    reach = of_node((24, 5))
    bent = replace(reach, positions_m=reach.positions_m + 0.01 * np.sin(reach.times_s)[:, None])
    there = turned(bent, np.array([0.3, -1.2, 0.7]), np.array([5.0, -2.0, 1.0]))
    here, moved = map_of(bent, STILL_M_S), map_of(there, STILL_M_S)
    assert np.abs(here.deviations - moved.deviations).max() < 1e-9
    assert np.nanmax(np.abs(here.arrival_s - moved.arrival_s)) < 1e-9


def test_agents_scale_with_distance_and_time() -> None:
    """Twice as far at twice the threshold, or thrice as slow at a third of it, is the same cut."""
    times_s, skews = np.array([0.5, 0.8, 1.4]), np.array([0.7, 1.0, 2.0])
    one = cut_agents(0.3, times_s, skews, 0.1)
    far, slow = cut_agents(0.6, times_s, skews, 0.2), cut_agents(0.3, 3.0 * times_s, skews, 0.1 / 3)
    assert far.arrival_s == pytest.approx(one.arrival_s, rel=1e-9)
    assert far.whole_m == pytest.approx(2.0 * one.whole_m, rel=1e-9)
    assert slow.arrival_s == pytest.approx(3.0 * one.arrival_s, rel=1e-9)


@pytest.mark.parametrize("skew", [0.6, 1.0, 2.0])
def test_the_agent_is_the_reach_of_the_simulation(skew: float) -> None:
    """Hardly cut at all, it covers the way as the simulated person's hand does."""
    agent = cut_agents(0.4, np.array([0.9]), np.array([skew]), 1e-4)
    times_s = np.linspace(0.0, 0.9, 31)
    expected = [0.4 * skewed_jerk(at / 0.9, skew) for at in times_s]
    assert agent.covered_m(times_s)[0] == pytest.approx(expected, abs=0.006)


def test_the_cut_leaves_exactly_the_recorded_distance() -> None:
    """What is slower than the threshold lies beyond both ends, and the agent then stays."""
    agent = cut_agents(0.2, np.array([0.7, 1.5]), np.array([1.0, 1.6]), STILL_M_S)
    assert (agent.whole_m > 0.2).all()
    covered = agent.covered_m(np.array([0.0, 99.0]))
    assert covered == pytest.approx(np.array([[0.0, 0.2], [0.0, 0.2]]), abs=1e-4)


def test_an_agent_that_is_always_slow_does_not_arrive() -> None:
    """Slower than the threshold all the way, it is never seen to move."""
    agent = cut_agents(0.1, np.array([9.0]), np.array([1.0]), STILL_M_S)
    assert np.isnan(agent.arrival_s).all()
    assert agent.covered_m(np.array([0.0, 5.0])).tolist() == [[0.0, 0.0]]


def test_a_usual_reach_has_a_tempo_of_one() -> None:
    """The agent in the simulation's assumed time, without skew, is the node in the middle."""
    found = map_of(reach_of_the_agent(1.0, 1.0), STILL_M_S)
    assert np.exp(found.read(TIME_AWARE).best) == pytest.approx([1.0, 1.0])
    assert found.reference_s < usual_time_s(0.4, NEAR_M)
