"""Samples as an export has them, of simulated people who reach in the open."""

from collections.abc import Sequence

import numpy as np

from app.science.simulation import MovementTraits
from app.science.skeleton import JOINT_NAMES, Pose
from tests.science.simulation.people import RATE_HZ, person_of, tip
from tests.science.simulation.reaches import touch

PLACES_M = (-0.25, 0.05, 0.3, -0.1)


def poses_of_reaches(seed: int, count: int, tempo: float = 1.0) -> list[Pose]:
    """Return the poses of somebody who touches one place after the other, and sees it at once."""
    person = person_of(seed, MovementTraits(tempo=tempo, patience_s=60.0, precision=0.3))
    poses: list[Pose] = []
    for at in range(count):
        goal = touch(PLACES_M[at % len(PLACES_M)], 1.2 + 0.05 * (at % 3))
        for _ in range(round(2.5 * RATE_HZ)):
            t_s = len(poses) / RATE_HZ
            poses.append(person.pose(t_s, goal))
            x, y, z = tip(poses[-1], "Right").tolist()
            person.see(t_s, "RightHand", (x, y, z))
    return poses


def as_samples(poses: Sequence[Pose]) -> str:
    """Return the target's part of a file of samples, all frames in phase 7."""
    state = ["simulated", "epoch", "seq", "phase_id", "t_s", "active", "flagged"]
    root = [f"target_root_{axis}_m" for axis in "xyz"]
    turns = [f"target_{joint}_q{part}" for joint in JOINT_NAMES for part in "wxyz"]
    lines = [",".join([*state, *root, *turns])]
    for seq, pose in enumerate(poses):
        numbers = np.concatenate([pose.root_position_m, pose.rotations.ravel()])
        cells = ",".join(f"{number:.7g}" for number in numbers)
        lines.append(f"true,1,{seq},7,{seq / RATE_HZ:.6f},true,false,{cells}")
    return "\n".join(lines) + "\n"
