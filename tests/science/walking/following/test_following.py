"""Tests of the path-following agent: limits of motion, and two forms that agree."""

import numpy as np
import pytest

from app.science.walking.following.course import course_of
from app.science.walking.following.following import FollowingRules, SteeringFollower
from app.science.walking.planning.grid_planner import LazyThetaPlanner
from app.science.walking.records.model import PlannedPath, Walk, WalkingError
from app.science.walking.records.parameters import PAPER_GRID
from app.science.walking.records.protocols import Course
from app.science.walking.scene.laboratory import pole_scene
from app.science.walking.scene.shapes import contains
from tests.science.walking.plain_agents import PlainFollower
from tests.science.walking.random_scenes import random_scene
from tests.science.walking.walkers import walker

FOLLOWER, PLAIN = SteeringFollower(), PlainFollower()
DT = FOLLOWER.dt_s
STRAIGHT = PlannedPath(np.array([[0.0, 0.0], [0.0, 4.0]]))
BENT = PlannedPath(np.array([[0.0, 0.0], [0.0, 2.0], [2.0, 2.0]]))


def _random_path(rng: np.random.Generator) -> PlannedPath:
    legs = rng.uniform(-1.0, 1.0, (int(rng.integers(1, 7)), 2))
    return PlannedPath(np.concatenate([np.zeros((1, 2)), np.cumsum(legs, axis=0)]))


def test_compiled_and_plain_agents_agree() -> None:
    """The compiled and the plain agent agree to 1e-9 on random paths, for the whole grid."""
    rng = np.random.default_rng(8)
    for at in range(6):
        course = Course(_random_path(rng), 90, 2.5, 0.3 * (at % 2), at % 3 > 0)
        vectors = rng.uniform(0.1, 2.0, (300, 3))
        ours, theirs = FOLLOWER.follow(course, vectors), PLAIN.follow(course, vectors)
        assert np.array_equal(ours.arrived, theirs.arrived)
        assert np.abs(ours.xy_m - theirs.xy_m).max() <= 1e-9
        late = np.abs(ours.arrival_s - theirs.arrival_s)[ours.arrived]
        assert late.max(initial=0.0) <= 1e-9


@pytest.mark.parametrize(("v", "a"), [(0.5, 0.5), (1.2, 1.0), (2.0, 0.4)])
def test_a_straight_walk_takes_as_long_as_physics_says(v: float, a: float) -> None:
    """A straight walk takes the time of a trapezoidal speed profile, to one step."""
    distance, radius, floor = 4.0, FollowingRules().radius_m, FollowingRules().floor_m_s
    peak = min(v, np.sqrt(a * distance))
    whole_s = distance / peak + peak / a
    expected_s = whole_s - np.sqrt(2.0 * radius / a) - floor / a
    result = FOLLOWER.follow(Course(STRAIGHT, 600, 30.0), np.array([[v, a, 1.0]]))
    assert result.arrival_s[0] == pytest.approx(expected_s, abs=0.5 * DT)
    assert result.xy_m[0, -1] == pytest.approx([0.0, 4.0], abs=radius)


def test_speed_acceleration_and_curvature_keep_their_limits() -> None:
    """Speed, acceleration and curvature keep their limits at every step of a bent path."""
    result = FOLLOWER.follow(Course(BENT, 300, 20.0), PAPER_GRID.nodes)
    steps = np.diff(result.xy_m, axis=1)
    lengths = np.linalg.norm(steps, axis=-1)
    moving = (lengths[:, 1:] > 0.0) & (lengths[:, :-1] > 0.0)
    v, a, omega = PAPER_GRID.nodes.T[:, :, None]
    floor = FollowingRules().floor_m_s
    assert (lengths <= np.maximum(v, floor) * DT + 1e-12).all()
    change = np.abs(np.diff(lengths, axis=1)) / DT
    assert (change[moving] <= np.broadcast_to(a * DT, change.shape)[moving] + 1e-9).all()
    cross = steps[:, :-1, 0] * steps[:, 1:, 1] - steps[:, :-1, 1] * steps[:, 1:, 0]
    dots = (steps[:, :-1] * steps[:, 1:]).sum(axis=-1)
    turned = np.abs(np.arctan2(cross, dots))
    # It turns by its speed between two steps, and the mean speeds of steps are known here.
    most = omega * (np.maximum(lengths[:, :-1], floor * DT) + 0.5 * a * DT * DT)
    assert (turned[moving] <= most[moving] * (1.0 + 1e-6) + 1e-9).all()


def test_an_agent_that_cannot_turn_enough_does_not_arrive() -> None:
    """With a turning radius of 10 m the agent misses a corner; with half a metre it arrives."""
    vectors = np.array([[1.0, 1.0, 0.1], [1.0, 1.0, 2.0]])
    result = FOLLOWER.follow(Course(BENT, 10, 12.0), vectors)
    assert result.arrived.tolist() == [False, True]
    assert np.isnan(result.arrival_s[0])


def test_a_walk_ends_at_the_time_limit() -> None:
    """An agent that is too slow has not arrived when the time limit elapses."""
    slow = np.array([[0.1, 1.0, 1.0]])
    assert not FOLLOWER.follow(Course(STRAIGHT, 10, 10.0), slow).arrived[0]
    assert FOLLOWER.follow(Course(STRAIGHT, 10, 45.0), slow).arrived[0]


def test_an_agent_that_has_arrived_stays() -> None:
    """All samples after the arrival are at the same place."""
    result = FOLLOWER.follow(Course(STRAIGHT, 600, 20.0), np.array([[1.0, 1.0, 1.0]]))
    after = int(result.arrival_s[0] / DT) + 2
    assert (result.xy_m[0, after:] == result.xy_m[0, after]).all()


def test_omega_does_not_matter_on_a_straight_path() -> None:
    """On a straight path agents of equal v and a move identically to the bit for any omega."""
    vectors = np.array([[1.1, 0.7, omega] for omega in (0.1, 0.5, 2.0)])
    bent_by_nothing = PlannedPath(np.array([[0.0, 0.0], [0.0, 1.5], [0.0, 4.0]]))
    each = FOLLOWER.follow(Course(bent_by_nothing, 200, 20.0), vectors)
    assert (each.xy_m == each.xy_m[0]).all()
    together = FOLLOWER.follow(Course(STRAIGHT, 200, 20.0), vectors)
    assert together.xy_m == pytest.approx(each.xy_m, abs=1e-9)


def test_a_walk_that_a_recording_cuts_begins_and_ends_at_speed() -> None:
    """For a walk that is cut off, the agent starts at its speed and passes the goal unbraked."""
    times = np.arange(121) / 60.0
    places = np.stack([np.zeros(121), 1.2 * times], axis=-1)
    walk = Walk(times, places, "1", "cut", begins_still=False, ends_still=False)
    path = PlannedPath(walk.xy_m[[0, -1]])
    result = FOLLOWER.follow(course_of(walk, path, DT), np.array([[1.2, 1.0, 1.0]]))
    assert result.arrival_s[0] == pytest.approx((2.4 - 0.05) / 1.2, abs=0.001)
    assert np.abs(result.xy_m[0, :118] - places[:118]).max() < 1e-9


def test_a_real_scene_is_walked_without_touching_walls() -> None:
    """Agents that turn well do not touch the pole's wall on any planned path."""
    scene = pole_scene(180.0, 3.0)
    path = LazyThetaPlanner(scene).plan(scene.places["start"], scene.places["goal"])
    vectors = PAPER_GRID.nodes[PAPER_GRID.nodes[:, 2] > 1.9]
    result = FOLLOWER.follow(Course(path, 900, 15.0), vectors)
    for obstacle in scene.obstacles:
        assert not contains(obstacle.corners_m, result.xy_m).any()


def test_invalid_vectors_courses_and_rules_are_rejected() -> None:
    """Invalid parameter vectors, courses without time and invalid rules are rejected."""
    course = Course(STRAIGHT, 10, 10.0)
    for vectors in (np.ones((2, 2)), np.array([[1.0, 0.0, 1.0]]), np.array([[1.0, np.nan, 1.0]])):
        with pytest.raises(WalkingError):
            FOLLOWER.follow(course, vectors)
    with pytest.raises(WalkingError, match="course"):
        FOLLOWER.follow(Course(STRAIGHT, 0, 10.0), np.ones((1, 3)))
    with pytest.raises(WalkingError, match="dt_s"):
        FollowingRules(dt_s=0.0)


def test_random_scenes_are_walked_to_their_goals() -> None:
    """A slow agent with a turning radius of half a metre reaches the goals of random scenes."""
    arrived = 0
    for seed in range(12):
        scene, start, goal = random_scene(np.random.default_rng(seed))
        path = LazyThetaPlanner(scene).plan(start, goal)
        course = Course(path, 2, 30.0)
        arrived += int(FOLLOWER.follow(course, np.array([[0.6, 0.5, 2.0]])).arrived[0])
    assert arrived >= 10


def test_a_made_walker_has_the_length_of_its_path() -> None:
    """The synthetic walkers of other tests go from start to goal and rest at both."""
    walk = walker(BENT, sway_m=0.0)
    assert walk.xy_m[[0, -1]] == pytest.approx(BENT.points_m[[0, -1]])
    assert walk.length_m == pytest.approx(4.0, rel=0.05)
    assert walk.speeds_m_s[[0, -1]] == pytest.approx([0.0, 0.0], abs=0.01)
