"""Tests that the simulated participant moves smoothly, reproducibly and in a closed loop."""

from pathlib import Path

import numpy as np
import pytest

from app.science import rotations as rot
from app.science.delay import DelayBuffer
from app.science.simulation import (
    Goal,
    GoalKind,
    idle_movement,
    relaxed_pose,
)
from app.science.skeleton import (
    JOINT_INDEX,
    Movement,
    Pose,
    forward_kinematics,
    largest_step_rad,
    loop,
    resample,
)
from app.simulated_people.body import captured_movement
from tests.science.simulation.people import (
    BOXES,
    IMPATIENT,
    RATE_HZ,
    SKELETON,
    follow,
    person_of,
    reach,
    rng_of,
    sole,
    step,
    tip,
)


def test_the_same_seed_gives_the_same_movement() -> None:
    """The same seed, times and goals give the same movement; another seed gives another."""
    goal = reach(BOXES[2])
    first, same, other = (
        np.stack([pose.rotations for pose in follow(person_of(seed, None), goal, 0.0, 2.0)])
        for seed in (4, 4, 5)
    )
    assert first.tobytes() == same.tobytes()
    assert float(np.max(rot.geodesic_angle(first, other))) > 0.05


def test_movement_is_smooth_through_every_change_of_goal() -> None:
    """No joint jumps when the goal changes between roaming, reaching, stepping and walking."""
    person = person_of(traits=None)
    goals = [
        None, reach(BOXES[0]), reach(BOXES[3]), reach(BOXES[1], "Left"), None,
        step((0.2, 0.01, -0.5), "Right"), Goal(GoalKind.WALK_TO, None, (0.0, 0.0, 0.0)),
        reach(BOXES[2]), Goal(GoalKind.REST), None,
    ]  # fmt: skip
    poses = [pose for i, goal in enumerate(goals) for pose in follow(person, goal, 2.0 * i, 2.0)]
    q = np.stack([pose.rotations for pose in poses])
    roots = np.stack([pose.root_position_m for pose in poses])
    # 22 rad/s is a fast elbow; a jump of 15 degrees in one frame would be 24.
    assert float(np.max(rot.geodesic_angle(q[1:], q[:-1]))) * RATE_HZ < 22.0
    assert float(np.abs(np.diff(roots, axis=0)).max()) * RATE_HZ < 2.0
    assert rot.is_unit(q, 1e-9).all()


@pytest.mark.parametrize("turned_deg", [120.0, 160.0, 180.0, 200.0])
def test_no_joint_turns_quicker_than_a_persons(turned_deg: float) -> None:
    """A hand that must turn by half a turn on its way to a goal turns no faster than a person's."""
    idle, hand = idle_movement(SKELETON, rng_of(99)), JOINT_INDEX["RightHand"]
    half = np.radians(turned_deg) / 2.0
    rotations = idle.rotations.copy()
    rotations[:, hand] = rot.multiply(
        rotations[:, hand], np.array([np.cos(half), np.sin(half), 0.0, 0.0])
    )
    base = Movement(idle.rate_hz, idle.root_positions_m, rotations)
    person = person_of(base=loop(base))
    follow(person, None, 0.0, 0.2)
    poses = follow(person, reach(BOXES[2]), 0.2, 2.0)
    q = np.stack([pose.rotations for pose in poses])
    turns = rot.geodesic_angle(q[1:], q[:-1]) * RATE_HZ
    assert np.degrees(turns.max()) <= 1500.0 + 1e-6
    assert float(np.abs(tip(poses[-1], "Right") - BOXES[2]).max()) < 0.02


def test_without_a_goal_the_base_movement_is_played_whole() -> None:
    """In free movement the participant plays the base movement itself, in place."""
    base = idle_movement(SKELETON, rng_of(99))
    poses = follow(person_of(base=base), None, 0.0, 1.0)
    nearest = [float(np.min(np.max(rot.geodesic_angle(base.rotations, p.rotations), axis=1)))
               for p in poses[::10]]  # fmt: skip
    assert max(nearest) < 0.01


def test_a_walking_capture_does_not_stride_at_the_boxes(shared_data: Path) -> None:
    """In a hand task a walking capture's feet stay in place, except for single side steps."""
    path = shared_data / "motion" / "cmu_bvh" / "02_01.bvh"
    clip = captured_movement(path, SKELETON)
    base = loop(resample(clip, RATE_HZ))
    person = person_of(base=base)
    follow(person, reach(BOXES[2]), 0.0, 2.0)
    soles = np.array([sole(p, "Left") for p in follow(person, reach(BOXES[2]), 2.0, 2.0)])
    assert float(np.ptp(soles, axis=0).max()) < 1e-3
    walking = np.array([sole(p, "Left") for p in follow(person_of(base=base), None, 0.0, 2.0)])
    assert float(np.ptp(walking[:, 2])) > 0.3


@pytest.mark.parametrize("latency_s", [0.0, 0.35])
def test_closed_loop_through_the_delayed_avatar_goes_on(latency_s: float) -> None:
    """Goals that change as the delayed avatar arrives are all met in order within a minute."""
    person, buffer = person_of(traits=None), DelayBuffer(latency_s)
    met, frame = 0, 0
    while met < 8 and frame < 60 * RATE_HZ:
        target = BOXES[met % 4]
        pose = person.pose(frame / RATE_HZ, reach(target))
        seen = Pose(pose.root_position_m, buffer.push(frame / RATE_HZ, pose.rotations))
        place = tip(seen, "Right")
        person.see(frame / RATE_HZ, "RightHand", tuple(place.tolist()))
        offset = place - target
        met += bool(np.abs(offset[:2]).max() < 0.09 and offset[2] <= 0.0)
        frame += 1
    assert met == 8


def test_a_touch_without_effect_is_repeated() -> None:
    """If the goal stays after a touch, the hand leaves the panel and touches it again."""
    poses = follow(person_of(traits=IMPATIENT), reach(BOXES[2]), 0.0, 6.0)
    depth = np.array([tip(pose, "Right")[2] for pose in poses]) - BOXES[2][2]
    begins = np.flatnonzero((depth[1:] <= 0.0) & (depth[:-1] > 0.0))
    assert len(begins) >= 2
    assert float(depth[begins[0] : begins[1]].max()) > 0.04


def test_the_participant_reacts_before_moving() -> None:
    """The hand does not move towards a new goal for at least 0.12 s."""
    person = person_of()
    follow(person, reach(BOXES[1]), 0.0, 3.0)
    tips = np.array([tip(p, "Right") for p in follow(person, reach(BOXES[2]), 3.0, 0.12)])
    assert float(np.ptp(tips, axis=0).max()) < 0.002


def test_idle_movement_repeats_without_a_seam() -> None:
    """The idle movement loops without a jump, and the person stands with hanging arms."""
    idle = idle_movement(SKELETON, rng_of())
    inside = largest_step_rad(Movement(idle.rate_hz, idle.root_positions_m, idle.rotations))
    assert largest_step_rad(idle) <= 1.01 * inside
    assert idle.duration_s == pytest.approx(30.0)
    world = forward_kinematics(SKELETON, np.zeros(3), relaxed_pose())
    hands = world.positions_m[[JOINT_INDEX["LeftHand"], JOINT_INDEX["RightHand"]]]
    assert float(hands[:, 1].max()) < 0.0
    assert hands[0, 0] < 0.0 < hands[1, 0]
