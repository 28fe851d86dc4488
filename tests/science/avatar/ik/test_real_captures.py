"""Tests of inverse kinematics from simulated trackers on captured movements of real people."""

from pathlib import Path

import numpy as np
import pytest

from app.science.avatar.ik import GOAL_PARTS, Goals, InverseKinematics
from app.science.avatar.ik.chain import Chain
from app.science.rotations import FloatArray
from app.science.skeleton import JOINT_INDEX, build_skeleton, forward_kinematics, resample
from app.simulated_people.body import captured_movement
from tests.science.avatar.ik import bodies

RATE_HZ = 90.0
LONGEST = 500
ROWS = [JOINT_INDEX[part] for part in GOAL_PARTS]
ELBOWS = [JOINT_INDEX[f"{side}LowerArm"] for side in ("Left", "Right")]
CLIPS = ["cmu_bvh/02_01.bvh", "cmu_bvh/12_02.bvh", "vicon_tracker/ObjectInspection_0.csv"]
"""Captures of a walk, of tai chi, and of a person who takes objects from a table."""


@pytest.mark.parametrize("file", CLIPS)
@pytest.mark.parametrize("waist", [True, False])
def test_trackers_of_real_people_are_followed(shared_data: Path, file: str, *, waist: bool) -> None:
    """Goals of real movements are met within 2.5 mm and 0.4 degrees on average.

    The elbow, which has no goal, stays within 10 cm of the person's.
    """
    skeleton = build_skeleton(bodies.STATURE_M)
    movement = resample(captured_movement(shared_data / "motion" / file, skeleton), RATE_HZ)
    world = forward_kinematics(skeleton, movement.root_positions_m, movement.rotations)
    tracked = np.ones(len(GOAL_PARTS), dtype=np.bool_)
    tracked[0] = waist
    solver, chain = InverseKinematics(bodies.model()), Chain(bodies.model())
    positions, rotations, elbows = [], [], []
    for frame in range(min(movement.frame_count, LONGEST)):
        goals = Goals(world.positions_m[frame, ROWS], world.rotations[frame, ROWS], tracked)
        solved = solver.solve(goals)
        positions.append(solved.position_errors_m[1:])
        rotations.append(solved.rotation_errors_rad[1:])
        chain.place(solved.hips_position_m, solved.hips_rotation, solved.angles_rad)
        places = [chain.data.body(f"{side}LowerArm").xpos for side in ("Left", "Right")]
        elbows.append(np.linalg.norm(np.array(places) - world.positions_m[frame, ELBOWS], axis=1))
    assert _mean(positions) < 0.0025
    assert np.degrees(_mean(rotations)) < 0.4
    assert _mean(elbows) < 0.10


def _mean(rows: list[FloatArray]) -> float:
    """Return the mean without the first half second, in which the body settles into its pose."""
    return float(np.mean(rows[int(RATE_HZ / 2) :]))
