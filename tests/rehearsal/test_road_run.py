"""Tests of a rehearsed phase on the road: its start, its traffic, and feet that follow the kerb."""

import json

import numpy as np
import pytest

from app.rehearsal.road_run import CrossingRun
from app.rehearsal.road_shape import RoadShape
from app.science.simulation import (
    Goal,
    GoalKind,
    MovementTraits,
    SimulatedParticipant,
    idle_movement,
)
from app.science.skeleton import JOINT_INDEX, Pose, build_skeleton, forward_kinematics
from tests.rehearsal.orders import Timeline, order
from tests.rehearsal.road_vectors import FILE, ROAD, make

SHAPE = RoadShape.of(ROAD)
FAR_Z_M = -6.6
ANKLES = [JOINT_INDEX["LeftFoot"], JOINT_INDEX["RightFoot"]]
STEADY = MovementTraits(0.2, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 9.0)


def test_the_ground_is_that_of_the_stored_vectors() -> None:
    """The page and the rehearsal read the same vectors, which are what the rule gives today."""
    assert json.loads(FILE.read_text()) == json.loads(json.dumps(make()))


def test_a_foot_stands_on_the_street_that_is_seen_there() -> None:
    """The street's height at the ankle, sunk as far as under the hips, is the foot's height."""
    for hips_z_m, ankle_z_m, sunk_m, lift_m in make()["rows"]:
        assert 0.0 <= sunk_m <= SHAPE.kerb_height_m
        assert abs(lift_m) <= SHAPE.kerb_height_m
        if hips_z_m == ankle_z_m and abs(abs(SHAPE.y_m(hips_z_m)) - SHAPE.lane_width_m) > 0.35:
            assert lift_m == pytest.approx(0.0, abs=1e-12)


def _across(footing: RoadShape | None) -> list[Pose]:
    skeleton, rng = build_skeleton(1.72), np.random.default_rng(4)
    person = SimulatedParticipant(skeleton, idle_movement(skeleton, rng), rng, traits=STEADY)
    person.stand_on(footing)
    ahead = Goal(GoalKind.WALK_TO, None, (0.0, 0.0, FAR_Z_M), 0.2, (0.0, 0.1, 0.0))
    return [person.pose(frame / 45.0, ahead) for frame in range(900)]


def test_rehearsed_feet_step_down_the_kerb_and_up_again_and_nothing_else_moves() -> None:
    """Each ankle is the lift higher than on a flat floor; the hips are where they were."""
    skeleton = build_skeleton(1.72)
    highest, lowest = 0.0, 0.0
    for flat, carried in zip(_across(None), _across(SHAPE), strict=True):
        assert carried.root_position_m.tolist() == flat.root_position_m.tolist()
        x, _, z = carried.root_position_m
        before = forward_kinematics(skeleton, flat.root_position_m, flat.rotations)
        after = forward_kinematics(skeleton, carried.root_position_m, carried.rotations)
        for ankle in ANKLES:
            ankle_z_m = float(before.positions_m[ankle, 2])
            lift_m = SHAPE.lift_m((0.0, ankle_z_m), (float(x), float(z)))
            rose_m = float(after.positions_m[ankle, 1] - before.positions_m[ankle, 1])
            # Hips stay: a straight leg does not reach all the way down; joints turn only so fast.
            assert min(0.0, lift_m) - 0.02 < rose_m < max(0.0, lift_m) + 0.02
            if lift_m > 0.0:
                assert rose_m == pytest.approx(lift_m, abs=0.02)
            highest, lowest = max(highest, rose_m), min(lowest, rose_m)
    assert highest > 0.08
    assert lowest < -0.03
    assert carried.root_position_m[2] == pytest.approx(FAR_Z_M, abs=0.3)


def _run() -> CrossingRun:
    return CrossingRun(order(until_completions=1, duration_s=60.0), SHAPE, 5.0, 0.0)


def _awaited(run: CrossingRun) -> str | None:
    return run.awaits


def test_a_phase_begins_on_the_start_square_and_once_cars_drive() -> None:
    """Whoever is on the other side walks back, and then gets the whole preparation."""
    run = _run()
    line = Timeline(run)
    run.walk(0.0, 0.0, FAR_Z_M)
    assert _awaited(run) == "start"
    goal = run.goal(())
    assert goal is not None
    assert goal.target_m == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)
    line.draw(2.0)
    assert line.words == []
    run.walk(line.t_s, 0.0, 0.1)
    run.follow_traffic(has_traffic=False)
    assert _awaited(run) == "traffic"
    line.draw(1.0)
    assert line.words == []
    run.follow_traffic(has_traffic=True)
    line.draw(0.1)
    assert line.words == ["started"]
    run.walk(line.t_s, 0.0, 0.0)
    run.walk(line.t_s + 0.1, 0.0, -0.1)
    assert run.news(line.t_s) == []


def test_a_pause_goes_on_only_with_cars_and_another_scene_counts_from_there() -> None:
    """A scene that broke off is waited for; the next one's step 0 is the active time then."""
    run = _run()
    line = Timeline(run)
    run.walk(0.0, 0.0, 0.0)
    run.enter_scene(0.0, 0.0, 0.0)
    line.draw(1.0)
    assert line.words == ["started"]
    line.follow(order(status="running", pausing=True, duration_s=60.0))
    run.follow_traffic(has_traffic=False)
    resuming = order(status="paused", resuming=True, duration_s=60.0)
    line.follow(resuming)
    assert line.words == ["started", "paused"]
    spent_s = run.active_s(line.t_s)
    assert run.enter_scene(line.t_s, 0.0, -1.0)[1] == pytest.approx(SHAPE.y_m(-1.0))
    assert run.begins_at_s == spent_s
    run.follow_traffic(has_traffic=True)
    line.follow(resuming)
    assert line.words == ["started", "paused", "resumed"]
    ((x_m, y_m, _, speed_m_s),) = run.walk(line.t_s, 0.0, -1.0)
    assert (x_m, y_m, speed_m_s) == pytest.approx((0.0, SHAPE.y_m(-1.0), 0.0))
