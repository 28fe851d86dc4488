"""Tests that the simulated avatar follows its targets, touches boxes and stays stable."""

import math
from pathlib import Path

import numpy as np
import pytest

from app.science.avatar.body.parts import AXES, AXIS_NAMES
from app.science.avatar.configuration.configuration import Hips
from app.science.avatar.mjcf.hinge_table import SimulationError
from app.science.avatar.simulation import frame_kernels
from app.science.avatar.simulation.simulation import PhysicsAvatar
from app.science.avatar.targets.targets import joint_rotations
from app.science.latency.achieved_latency import achieved_latency
from app.science.rotations import geodesic_angle, identity
from tests.science.avatar.captured import LONG, RATE_HZ, REACH, TURN, WALK, captured
from tests.science.avatar.simulated import angle_of, angles, avatar, follow, model, run
from tests.science.avatar.stress import STEP_S, WALL_FACE_M, run_random_poses, swing_into_a_wall

HIPS_M = np.array([0.0, 0.954, 0.0])
TO_THE_RIGHT = np.array([1.0, 0.0, 0.0])
FRAME_S = 1.0 / RATE_HZ


def test_the_t_pose_stays() -> None:
    """After two seconds in the T-pose no joint has sunk by a degree under the body's weight."""
    body = avatar()
    run(body, angles(), 180)
    assert np.degrees(np.nanmax(np.abs(body.state().angles_rad))) < 1.0
    assert not body.contacts()


def test_hips_move_in_a_straight_line_at_one_speed() -> None:
    """Each step of a frame brings the hips an equal way nearer to the frame's pose, the last to it.

    They turn by equal angles; the way of half as many steps is every other of them.
    """
    start = ((0.0, 0.9, 0.0), (1.0, 0.0, 0.0, 0.0))
    end = ((0.06, 0.93, -0.03), (math.cos(0.2), 0.0, math.sin(0.2), 0.0))
    way = frame_kernels.hips_way(start, end, 6)
    steps = np.diff(way[:, :3], axis=0, prepend=[start[0]])
    np.testing.assert_allclose(steps, np.tile([0.01, 0.005, -0.005], (6, 1)), atol=1e-15)
    turns = geodesic_angle(np.vstack(([start[1]], way[:-1, 3:])), way[:, 3:])
    np.testing.assert_allclose(turns, 0.4 / 6.0, rtol=0.01)
    np.testing.assert_array_equal(way[-1], (*end[0], *end[1]))
    np.testing.assert_allclose(frame_kernels.hips_way(start, end, 3), way[1::2], atol=1e-15)


@pytest.mark.parametrize(
    "name", ["LeftUpperArmZ", "RightLowerArmY", "LeftUpperLegX", "LeftLowerLegX"]
)
def test_a_step_is_reached(name: str) -> None:
    """A target that jumps by 30 degrees is reached within a second."""
    sign = -1.0 if name == "LeftUpperArmZ" else 1.0
    body = avatar()
    run(body, angles(**{name: sign * math.radians(30.0)}), 90)
    assert math.degrees(angle_of(body, name)) == pytest.approx(sign * 30.0, abs=1.0)


@pytest.mark.parametrize("capture", [WALK, REACH, TURN, LONG])
def test_real_movements_are_followed(shared_data: Path, capture: str) -> None:
    """Errors from the clamped command average 1.5 deg (95th percentile 5 deg) at most at 90 Hz."""
    followed = follow(model(), captured(shared_data, capture))
    errors = followed.errors_deg()
    assert errors.mean() < 1.5
    assert np.percentile(errors, 95) < 5.0
    assert followed.body.health.restored == 0


@pytest.mark.parametrize("ordered_s", [0.0, 0.125, 0.350])
def test_added_latency_is_achieved_within_a_frame(shared_data: Path, ordered_s: float) -> None:
    """The latency measured between the two streams is the set delay to within 11.1 ms."""
    movement = captured(shared_data, LONG)
    followed = follow(model(), movement, delay_s=ordered_s)
    command = joint_rotations(followed.targets.angles_rad, movement.rotations[:, 0])
    times_s = np.arange(movement.frame_count) / RATE_HZ
    achieved = achieved_latency(times_s, command, times_s, followed.rotations)
    assert achieved.latency_s == pytest.approx(ordered_s, abs=FRAME_S)


def test_the_hips_are_never_late(shared_data: Path) -> None:
    """Carried hips are exactly where the participant's are, at any delay."""
    movement = captured(shared_data, WALK)
    followed = follow(model(), movement, delay_s=0.350)
    np.testing.assert_allclose(followed.roots_m, movement.root_positions_m, atol=1e-12)
    turned = geodesic_angle(followed.rotations[:, 0], movement.rotations[:, 0])
    assert turned.max() < 1e-9


def test_a_hand_does_not_enter_a_wall() -> None:
    """A hand at 2 m/s enters a wall by at most 5 mm, reported as a contact, and never passes."""
    found = swing_into_a_wall()
    assert found.speed_m_s > 1.7
    assert found.touched == {"wall"}
    assert found.deepest_m <= 0.005
    assert found.farthest_m > WALL_FACE_M
    assert found.least_force_n >= 0.0


def _assert_survives_random_poses(hips: Hips, jumps: int, every: int) -> None:
    outcome = run_random_poses(hips, jumps, every)
    body = outcome.body
    assert outcome.always_finite
    assert body.health.restored == 0
    assert body.health.teleports == jumps // every
    assert body.time_s == round(jumps / RATE_HZ / STEP_S) * STEP_S
    assert body.data.time == pytest.approx(body.time_s, abs=1e-6)


@pytest.mark.parametrize("hips", ["carried", "welded"])
def test_random_poses_and_teleports_cause_no_failure(hips: Hips) -> None:
    """500 random poses and 50 teleports into walls cause no failure and no reset."""
    _assert_survives_random_poses(hips, 500, 10)


@pytest.mark.long
@pytest.mark.parametrize("hips", ["carried", "welded"])
def test_many_random_poses_and_teleports_cause_no_failure(hips: Hips) -> None:
    """10,000 random poses and 1,000 teleports of up to 10 m cause no failure and no reset."""
    _assert_survives_random_poses(hips, 10_000, 10)


def test_a_state_that_is_not_finite_is_restored() -> None:
    """A non-finite state is counted and replaced by the previous pose; the clock goes on."""
    body = avatar()
    bent = angles(LeftLowerArmY=0.5)
    run(body, bent, 90)
    body.data.qvel[3] = np.nan
    body.set_targets(bent)
    body.step_to(1.1)
    assert body.health.restored == 1
    assert body.time_s == pytest.approx(1.1)
    assert body.data.time == pytest.approx(1.1)
    assert angle_of(body, "LeftLowerArmY") == pytest.approx(0.5, abs=0.02)
    run(body, bent, 90)
    assert body.health.restored == 1


def test_targets_that_are_not_finite_are_ignored() -> None:
    """A NaN among targets or hips is counted, and the body stays unchanged."""
    body = avatar()
    body.set_hips(np.array([np.nan, 1.0, 0.0]), identity())
    run(body, np.full(len(AXES), np.nan), 10)
    assert body.health.ignored_inputs == 11
    assert np.degrees(np.nanmax(np.abs(body.state().angles_rad))) < 1.0


def test_targets_move_at_most_at_the_greatest_speed() -> None:
    """A target that jumps by 90 degrees is limited in speed, and the limiting is reported."""
    body = avatar()
    body.set_targets(angles(LeftLowerArmY=math.pi / 2))
    body.step_to(FRAME_S)
    command = body.state().command_rad[AXIS_NAMES.index("LeftLowerArmY")]
    assert 0.0 < command <= 40.0 * FRAME_S + 40.0 * STEP_S
    assert body.health.limited_targets == 1


def test_hips_that_jump_are_teleported_and_others_are_not() -> None:
    """A jump of the hips by two metres is a teleport; a step of 0.1 m is a movement."""
    body = avatar(hips="welded")
    body.set_hips(HIPS_M + 2.0 * TO_THE_RIGHT, identity())
    body.step_to(FRAME_S)
    assert body.state().root_position_m[0] == pytest.approx(2.0, abs=1e-3)
    body.set_hips(HIPS_M + 2.1 * TO_THE_RIGHT, identity())
    body.step_to(2 * FRAME_S)
    assert body.health.teleports == 1


def test_invalid_models_delays_times_and_hinges_are_rejected() -> None:
    """Invalid models, delays, times and unknown hinges raise errors that name them."""
    with pytest.raises(SimulationError, match="cannot load"):
        PhysicsAvatar("<mujoco><nonsense/></mujoco>")
    with pytest.raises(SimulationError, match="no hips"):
        PhysicsAvatar("<mujoco/>")
    body = avatar()
    with pytest.raises(SimulationError, match="longest_delay_s"):
        body.switches.set_delay(5.0)
    body.step_to(1.0)
    with pytest.raises(SimulationError, match="lies before"):
        body.step_to(0.5)
    with pytest.raises(SimulationError, match="LeftLowerArmZ"):
        body.switches.hold(["LeftLowerArmZ"])
