"""A generated walk whose lifts, stride lengths and lift heights are known.

A person stands, takes steps beginning with the left foot, closes the feet and stands. Feet are flat
and rest exactly while they are down; a swing follows smooth curves drawn by hand, not anybody's
movement. Thighs and shins come from `reach_for`, so any rig with the joints of the product's body
can walk it, whatever its proportions. Trunk and arms stay in the T-pose, except that the arms hang.
"""

from dataclasses import dataclass

import numpy as np

from app.science.retargeting.leg_reach import reach_for
from app.science.retargeting.legs import legs_of
from app.science.retargeting.reference_avatars import REFERENCE_JOINT_MAP, reference_avatar
from app.science.rig import Rig, RigMotion, to_local
from app.science.rotations import FloatArray, from_rotation_vector, identity, multiply

WALK_RATE_HZ = 120.0
STAND_S, SWING_S, DOUBLE_S = 0.5, 0.4, 0.15
GENERATED_STATURE_M = 1.75
_ARMS_DOWN_RAD = 1.25


@dataclass(frozen=True, eq=False)
class GeneratedWalk:
    """A generated walk along -z and its truth.

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


def generated_walk(
    rig: Rig,
    *,
    step_m: float = 0.6,
    steps: int = 4,
    height_m: float = 0.12,
    arms_hang: bool = False,
) -> GeneratedWalk:
    """Return a walk of `steps` steps of `step_m` that ends with closed feet.

    `rig`: named like the joints of the product's body, in the T-pose at rest.
    """
    lengths = [step_m, *(2.0 * step_m for _ in range(steps - 1)), step_m]
    lifts = [STAND_S + n * (SWING_S + DOUBLE_S) for n in range(len(lengths))]
    times = np.arange(round((lifts[-1] + SWING_S + STAND_S) * WALK_RATE_HZ) + 1) / WALK_RATE_HZ
    feet = np.zeros((2, len(times), 3))
    for number, (lift, length) in enumerate(zip(lifts, lengths, strict=True)):
        u = np.clip((times - lift) / SWING_S, 0.0, 1.0)
        foot = feet[number % 2]
        foot[:, 2] -= length * u * u * (3.0 - 2.0 * u)
        foot[:, 1] += height_m * np.sin(np.pi * u) ** 2
    motion = _walking(rig, feet, crouch_m=step_m**2 / 4.0 + 0.02, arms_hang=arms_hang)
    return GeneratedWalk(
        motion, tuple((lift, lift + SWING_S) for lift in lifts), tuple(lengths), height_m
    )


def example_walk() -> RigMotion:
    """Return eight steps of 0.7 m by a body 1.75 m tall, to look at avatars without a capture."""
    rig = reference_avatar(GENERATED_STATURE_M)
    return generated_walk(rig, step_m=0.7, steps=8, height_m=0.16, arms_hang=True).motion


def _walking(rig: Rig, feet_m: FloatArray, crouch_m: float, *, arms_hang: bool) -> RigMotion:
    """Return hips midway between the feet, and legs that reach the feet (2, N, 3) from rest."""
    frames = feet_m.shape[1]
    root = np.tile(rig.offsets_m[0], (frames, 1))
    root[:, 2] += feet_m[:, :, 2].mean(axis=0)
    root[:, 1] -= crouch_m
    rotations = identity(frames, rig.joint_count)
    if arms_hang:
        for name, sign in (("LeftUpperArm", 1.0), ("RightUpperArm", -1.0)):
            down = np.array([0.0, 0.0, sign * _ARMS_DOWN_RAD])
            rotations[:, rig.index(name)] = from_rotation_vector(down)
    known = np.ones((frames, rig.joint_count), dtype=np.bool_)
    motion = RigMotion(rig, WALK_RATE_HZ, root, rotations, known)
    positions, world = motion.world()
    at_rest, _ = rig.rest_world()
    legs = legs_of(rig, REFERENCE_JOINT_MAP)
    right = positions[:, legs.right.thigh] - positions[:, legs.left.thigh]
    for leg, foot in zip(legs.both, feet_m, strict=True):
        hip, knee, ankle = (positions[:, joint] for joint in (leg.thigh, leg.shin, leg.foot))
        reach = reach_for(hip, knee, ankle, at_rest[leg.foot] + foot, right)
        if reach.short_m.any():
            raise ValueError("the legs cannot reach steps of this length")
        world[:, leg.thigh] = multiply(reach.thigh_turns, world[:, leg.thigh])
        world[:, leg.shin] = multiply(reach.shin_turns, world[:, leg.shin])
    return RigMotion(rig, WALK_RATE_HZ, root, to_local(rig, world), motion.observed)
