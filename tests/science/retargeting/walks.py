"""A synthetic walk whose lifts, step lengths and step heights are known.

A person stands, takes steps beginning with the left foot, closes the feet and stands. Feet are flat
and rest exactly while they are down. Thighs and shins come from `reach_for`, so any rig with the
joints of the product's body can walk it, whatever its proportions.
"""

from dataclasses import dataclass

import numpy as np

from app.science.retargeting.leg_reach import reach_for
from app.science.retargeting.legs import Legs, legs_of
from app.science.rig import Rig, RigMotion, to_local
from app.science.rotations import FloatArray, identity, multiply
from tests.science.retargeting.bodies import SAME

RATE_HZ = 120.0
STAND_S, SWING_S, DOUBLE_S = 0.5, 0.4, 0.15


@dataclass(frozen=True, eq=False)
class MadeWalk:
    """A synthetic walk along -z and its truth.

    Attributes:
        motion: the movement.
        lifts_s: (time of lift, time of contact) of every swing in order.
        lengths_m: length of each swing.
        height_m: height of the foot in the middle of each swing.
    """

    motion: RigMotion
    lifts_s: tuple[tuple[float, float], ...]
    lengths_m: tuple[float, ...]
    height_m: float


def made_walk(rig: Rig, *, step_m: float = 0.6, steps: int = 4, height_m: float = 0.12) -> MadeWalk:
    """Return a walk of `steps` steps of `step_m` that ends with closed feet."""
    lengths = [step_m, *(2.0 * step_m for _ in range(steps - 1)), step_m]
    lifts = [STAND_S + n * (SWING_S + DOUBLE_S) for n in range(len(lengths))]
    times = np.arange(round((lifts[-1] + SWING_S + STAND_S) * RATE_HZ) + 1) / RATE_HZ
    feet = np.zeros((2, len(times), 3))
    for number, (lift, length) in enumerate(zip(lifts, lengths, strict=True)):
        u = np.clip((times - lift) / SWING_S, 0.0, 1.0)
        foot = feet[number % 2]
        foot[:, 2] -= length * u * u * (3.0 - 2.0 * u)
        foot[:, 1] += height_m * np.sin(np.pi * u) ** 2
    motion = _walking(rig, feet, crouch_m=step_m**2 / 4.0 + 0.02)
    return MadeWalk(
        motion, tuple((lift, lift + SWING_S) for lift in lifts), tuple(lengths), height_m
    )


def mapped(rig: Rig) -> Legs:
    """Return the mapped legs of a rig whose joints are named like the body's."""
    return legs_of(rig, SAME)


def _walking(rig: Rig, feet_m: FloatArray, crouch_m: float) -> RigMotion:
    """Return hips midway between the feet, and legs that reach the feet (2, N, 3) from rest."""
    frames = feet_m.shape[1]
    root = np.tile(rig.offsets_m[0], (frames, 1))
    root[:, 2] += feet_m[:, :, 2].mean(axis=0)
    root[:, 1] -= crouch_m
    motion = _still(rig, root)
    positions, world = motion.world()
    at_rest, _ = rig.rest_world()
    legs = mapped(rig)
    right = positions[:, legs.right.thigh] - positions[:, legs.left.thigh]
    for leg, foot in zip(legs.both, feet_m, strict=True):
        hip, knee, ankle = (positions[:, joint] for joint in (leg.thigh, leg.shin, leg.foot))
        reach = reach_for(hip, knee, ankle, at_rest[leg.foot] + foot, right)
        assert not reach.short_m.any(), "the legs cannot reach steps of this length"
        world[:, leg.thigh] = multiply(reach.thigh_turns, world[:, leg.thigh])
        world[:, leg.shin] = multiply(reach.shin_turns, world[:, leg.shin])
    return RigMotion(rig, RATE_HZ, root, to_local(rig, world), motion.observed)


def _still(rig: Rig, root_m: FloatArray) -> RigMotion:
    frames, joints = len(root_m), rig.joint_count
    return RigMotion(
        rig, RATE_HZ, root_m, identity(frames, joints), np.ones((frames, joints), dtype=np.bool_)
    )
