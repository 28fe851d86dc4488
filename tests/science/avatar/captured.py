"""Captured movements at the headset's rate, retargeted to the product's body."""

from functools import cache
from pathlib import Path

from app.science.retargeting import movement_travelling, propose_joint_map
from app.science.skeleton import Movement, build_skeleton, resample
from app.simulated_people.body import captured_movement, skeleton_motion

RATE_HZ = 90.0
STATURE_M = 1.75
WALK = "cmu_bvh/02_01.bvh"
REACH = "vicon_tracker/ObjectInspection_0.csv"
TURN = "cmu_bvh/05_06.bvh"
LONG = "cmu_asfamc/02_06.amc"
WALKS = (WALK, "cmu_bvh/06_01.bvh", "cmu_bvh/12_02.bvh")


def movement_of(path: Path, *, travels: bool) -> Movement:
    """Return a capture retargeted to the product's body at 90 Hz.

    With `travels` it keeps its own travel and turning; without, it moves in place and faces -z, as
    a participant who stays at the tables.
    """
    if not travels:
        return resample(captured_movement(path, build_skeleton(STATURE_M)), RATE_HZ)
    source = skeleton_motion(path)
    joint_map = propose_joint_map(source.rig).joint_map
    return resample(movement_travelling(source, joint_map, build_skeleton(STATURE_M)), RATE_HZ)


def captured(shared_data: Path, name: str) -> Movement:
    """Return a capture of the shared data at 90 Hz, moving in place; it is cached."""
    return _read(shared_data / "motion" / name, travels=False)


def travelling(shared_data: Path, name: str) -> Movement:
    """Return a capture of the shared data at 90 Hz with the person's own travel and turning."""
    return _read(shared_data / "motion" / name, travels=True)


@cache
def _read(path: Path, *, travels: bool) -> Movement:
    return movement_of(path, travels=travels)
