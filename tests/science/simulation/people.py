"""Participants, goals and measuring points for the tests of the simulated participant."""

import numpy as np

from app.science import rotations as rot
from app.science.simulation import (
    Goal,
    GoalKind,
    MovementTraits,
    SimulatedParticipant,
    idle_movement,
)
from app.science.skeleton import JOINT_INDEX, Movement, Pose, build_skeleton, forward_kinematics

RATE_HZ = 90.0
SKELETON = build_skeleton(1.75)
# Aims exactly and never retries, so that the final pose can be measured.
EXACT = MovementTraits(precision=0.0, patience_s=60.0)
IMPATIENT = MovementTraits(precision=0.0)
BOXES = [(-0.375 + 0.25 * i, 1.25, -0.7) for i in range(4)]


def rng_of(seed: int = 1) -> np.random.Generator:
    """Return a seeded random generator."""
    return np.random.default_rng(seed)


def person_of(
    seed: int = 1, traits: MovementTraits | None = EXACT, base: Movement | None = None
) -> SimulatedParticipant:
    """Return a participant, by default a precise and patient one (`EXACT`)."""
    base = base or idle_movement(SKELETON, rng_of(99))
    return SimulatedParticipant(SKELETON, base, rng_of(seed), traits=traits)


def follow(
    person: SimulatedParticipant, goal: Goal | None, start_s: float, for_s: float
) -> list[Pose]:
    """Return the participant's poses over some seconds with one goal."""
    frames = round(for_s * RATE_HZ)
    return [person.pose(start_s + i / RATE_HZ, goal) for i in range(frames)]


def tip(pose: Pose, side: str) -> rot.FloatArray:
    """Return the position of the fingertip in the world."""
    world = forward_kinematics(SKELETON, pose.root_position_m, pose.rotations)
    hand = JOINT_INDEX[f"{side}Hand"]
    turned = rot.rotate(world.rotations[hand], SKELETON.ends_m[hand])
    return np.asarray(world.positions_m[hand] + turned)


def sole(pose: Pose, side: str) -> rot.FloatArray:
    """Return the position of the middle of the sole in the world."""
    world = forward_kinematics(SKELETON, pose.root_position_m, pose.rotations)
    ahead = np.array((0.0, -SKELETON.ankle_height_m, -0.038 * SKELETON.stature_m))
    return np.asarray(world.positions_m[JOINT_INDEX[f"{side}Foot"]] + ahead)


def reach(target: tuple[float, float, float], side: str = "Right") -> Goal:
    """Return a goal to touch a panel at the far end of a box."""
    return Goal(GoalKind.REACH, f"{side}Hand", target, 0.05, (0.0, 0.0, 0.3))


def step(target: tuple[float, float, float], side: str) -> Goal:
    """Return a goal to step into a box."""
    return Goal(GoalKind.STEP, f"{side}Foot", target, 0.05, (0.0, 0.25, 0.0))
