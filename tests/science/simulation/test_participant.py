"""Tests of reaching, stepping and walking by the simulated participant, and of bad goals."""

import numpy as np
import pytest

from app.science import rotations as rot
from app.science.simulation import (
    Goal,
    GoalKind,
    SimulationError,
)
from app.science.skeleton import (
    JOINT_INDEX,
    Movement,
    forward_kinematics,
)
from tests.science.simulation.people import (
    BOXES,
    SKELETON,
    follow,
    person_of,
    reach,
    sole,
    step,
    tip,
)


@pytest.mark.parametrize("side", ["Left", "Right"])
@pytest.mark.parametrize("box", range(4))
def test_every_hand_box_is_reached_to_a_millimetre(side: str, box: int) -> None:
    """The fingertip reaches its target in each box within a millimetre, with either hand."""
    person = person_of()
    pose = follow(person, reach(BOXES[box], side), 0.0, 2.5)[-1]
    assert person.aimed_m is not None
    assert float(np.linalg.norm(tip(pose, side) - person.aimed_m)) < 1e-3
    # The target itself lies a little inside the panel; there is no other deviation.
    np.testing.assert_allclose(person.aimed_m[:2], BOXES[box][:2], atol=1e-4)
    assert -0.05 < person.aimed_m[2] - BOXES[box][2] < -0.005


@pytest.mark.parametrize("side", ["Left", "Right"])
@pytest.mark.parametrize("target", [(-0.5, 0.01, -0.6), (0.2, 0.01, -0.9), (0.0, 0.15, -1.2)])
def test_floor_targets_are_stepped_on(side: str, target: tuple[float, float, float]) -> None:
    """The participant's sole ends flat on its target, also several steps away and on a bar."""
    person = person_of()
    pose = follow(person, step(target, side), 0.0, 6.0)[-1]
    np.testing.assert_allclose(sole(pose, side), person.aimed_m or (), atol=1e-3)
    np.testing.assert_allclose(sole(pose, side), target, atol=1e-3)
    world = forward_kinematics(SKELETON, pose.root_position_m, pose.rotations)
    foot = world.rotations[JOINT_INDEX[f"{side}Foot"]]
    assert float(rot.geodesic_angle(foot, rot.identity())) < 1e-6


def test_the_hand_enters_and_leaves_a_box_by_its_opening() -> None:
    """The fingertip stays in line with a box's opening on the way in and out."""
    person = person_of()
    poses = follow(person, reach(BOXES[3]), 0.0, 2.5)
    poses += follow(person, reach(BOXES[0]), 2.5, 3.0)
    tips = np.array([tip(pose, "Right") for pose in poses])
    deep = tips[:, 2] < -0.55
    aside = np.min([np.abs(tips[:, 0] - x) for x, _, _ in (BOXES[3], BOXES[0])], axis=0)
    assert deep.sum() > 50
    assert float(aside[deep].max()) < 0.04


def test_feet_lift_over_the_edge_of_a_box() -> None:
    """The participant's foot is above the box's edge between its start and its goal."""
    person = person_of()
    poses = follow(person, step((0.3, 0.01, -0.6), "Right"), 0.0, 3.0)
    soles = np.array([sole(pose, "Right") for pose in poses])
    from_start = np.hypot(*(soles - soles[0])[:, [0, 2]].T)
    from_goal = np.hypot(*(soles - soles[-1])[:, [0, 2]].T)
    between = (from_start > 0.12) & (from_goal > 0.12)
    assert between.sum() > 5
    assert float(soles[between, 1].min()) > 0.2


def test_walking_back_brings_the_body_home() -> None:
    """The participant walks back from the bar to the start square and stands there."""
    person = person_of()
    follow(person, step((0.0, 0.15, -1.2), "Right"), 0.0, 5.0)
    home = Goal(GoalKind.WALK_TO, None, (0.0, 0.0, 0.0))
    pose = follow(person, home, 5.0, 8.0)[-1]
    assert float(np.hypot(*pose.root_position_m[[0, 2]])) < 0.03
    for side in ("Left", "Right"):
        assert float(sole(pose, side)[1]) == pytest.approx(0.0, abs=1e-3)


def test_a_goal_out_of_reach_leaves_the_arm_stretched_towards_it() -> None:
    """With a target metres away the participant's body stays finite, upright and near."""
    person = person_of()
    goal = Goal(GoalKind.REACH, "RightHand", (0.0, 1.3, -6.0))
    pose = follow(person, goal, 0.0, 6.0)[-1]
    assert rot.is_unit(pose.rotations, 1e-9).all()
    assert float(np.hypot(*pose.root_position_m[[0, 2]])) < 0.9
    assert float(tip(pose, "Right")[2]) < -0.9


def test_invalid_requests_are_rejected() -> None:
    """Times that go back, bases that do not loop and far walks are rejected."""
    person = person_of()
    person.pose(1.0, None)
    with pytest.raises(SimulationError, match="in order"):
        person.pose(0.5, None)
    still = Movement(90.0, np.zeros((10, 3)), rot.identity(10, 22))
    with pytest.raises(SimulationError, match="must loop"):
        person_of(base=still)
    with pytest.raises(SimulationError, match="steps away"):
        follow(person, Goal(GoalKind.WALK_TO, None, (0.0, 0.0, 500.0)), 1.0, 1.0)


@pytest.mark.parametrize(
    ("kind", "effector", "target"),
    [
        (GoalKind.REACH, "LeftFoot", (0.0, 0.0, 0.0)),
        (GoalKind.STEP, None, (0.0, 0.0, 0.0)),
        (GoalKind.REACH, "LeftHand", None),
        (GoalKind.REST, None, (0.0, 0.0, 0.0)),
        (GoalKind.STEP, "LeftFoot", (0.0, float("nan"), 0.0)),
    ],
)
def test_invalid_goals_are_rejected(
    kind: GoalKind, effector: str | None, target: tuple[float, float, float] | None
) -> None:
    """A wrong limb, a missing or surplus target and non-finite numbers are rejected."""
    with pytest.raises(SimulationError):
        Goal(kind, effector, target)
