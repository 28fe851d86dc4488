"""Foot locking: keep feet from sliding while they are on the ground.

An avatar with the person's proportions walks without sliding at any size. With another thigh:shin
ratio the same joint angles move the foot elsewhere, and it slides while it should stand. Locking
holds each foot, during each contact of the *source*, at one place:

    c(t) = (mean x, ground there, mean z) - (x, y, z)(t) of the sole below the ball,
    ankle(t) = unlocked ankle(t) + c(t).

Between two contacts c changes smoothly from the end of one to the start of the next, before the
first and after the last it is constant, so nothing pops. On flat ground a foot is then lifted,
smoothly, where its lowest point would still be under the floor: a toe that was measured pointing
down, most of all while the foot leaves the ground. Feet keep their orientation, so they still
roll from heel to toe, and legs reach for the ankles (`leg_reach`). The body rises and sinks with
its feet: the hips are raised by the smoothed mean of both corrections' heights, and so follow a
ground that was not in the capture. Where a leg is then too short, the hips are lowered by a limited
amount; if the target is still out of reach, the leg points towards it, stretched as far as allowed,
and the frame is counted.
"""

from dataclasses import dataclass

import numpy as np

from app.science.retargeting.contacts import Contacts, mean_slide_m_s
from app.science.retargeting.foot_holding import held_shifts
from app.science.retargeting.ground import Flat, Ground
from app.science.retargeting.joint_map import JointMap
from app.science.retargeting.leg_reach import Reach, longest_m, reach_for
from app.science.retargeting.legs import Leg, Legs, legs_of
from app.science.rig import Rig, RigError, RigMotion, to_local, to_world
from app.science.rotations import FloatArray, multiply
from app.science.skeleton import clearance_m

_FLAT = Flat()
# A foot that misses its place by less than this is not visible.
_REACHED_M = 1e-3


@dataclass(frozen=True)
class LockLimits:
    """Limits of the correction by foot locking.

    Attributes:
        smoothing_s: time over which the hips' rise and fall is smoothed, either way.
        settling_s: time in which a foot returns to its own speed before and after a contact.
        deepest: largest lowering of the hips to let both feet reach, in leg lengths.
        sunk_m: depth of a foot's lowest point under flat ground that is left as it is: soles give
            by about as much.
    """

    smoothing_s: float = 0.2
    settling_s: float = 0.15
    deepest: float = 0.04
    sunk_m: float = 0.008


_DEFAULT = LockLimits()


@dataclass(frozen=True, eq=False)
class LockedFeet:
    """A movement with its feet locked, and measures of the correction.

    Attributes:
        motion: the movement.
        slide_before_m_s, slide_after_m_s: mean horizontal speed of feet in contact; None without
            any contact.
        lowered_m: largest lowering of the hips to let the legs reach.
        out_of_reach: frames in which a foot in contact could not reach its place, both feet added.
        lifted_m: largest lift of a foot that keeps its lowest point above flat ground.
    """

    motion: RigMotion
    slide_before_m_s: float | None
    slide_after_m_s: float | None
    lowered_m: float
    out_of_reach: int
    lifted_m: float


def lock_feet(
    motion: RigMotion,
    joint_map: JointMap,
    contacts: Contacts,
    ground: Ground = _FLAT,
    limits: LockLimits = _DEFAULT,
) -> LockedFeet:
    """Hold the feet of an avatar in place while the source's are down.

    Args:
        motion: the avatar's movement, after the transfer.
        joint_map: the joint map of the avatar.
        contacts: the contacts of the source, from `find_contacts`, with the same number of frames.
        ground: the ground under the avatar.
        limits: the limits of the correction.

    Raises:
        RigError: the legs are not mapped, or the contacts have a different number of frames.
    """
    legs = legs_of(motion.rig, joint_map)
    if len(contacts.down) != motion.frame_count:
        raise RigError(
            f"{len(contacts.down)} frames of contacts do not match"
            f" {motion.frame_count} frames of movement."
        )
    positions, world = motion.world()
    shifts = held_shifts(positions, world, legs, contacts, ground, limits.settling_s)
    reach = max(1, round(limits.smoothing_s * motion.rate_hz))
    raise_m = np.zeros((motion.frame_count, 3))
    raise_m[:, 1] = _smooth(shifts[..., 1].mean(axis=0), reach)
    # The hips do not follow: raised with one foot, they would overstretch the other leg.
    lift_m = np.zeros(shifts.shape[:2])
    if isinstance(ground, Flat):
        lift_m = _lift_m(positions, world, legs, shifts, ground.level_m, motion.rate_hz, limits)
        shifts[..., 1] += lift_m
    targets = shifts + np.stack([positions[:, leg.foot] for leg in legs.both])
    raised = positions + raise_m[:, np.newaxis]
    lowered = _hip_lowering(raised, legs, targets, limits.deepest * legs.length_m, reach)
    root = motion.root_positions_m + raise_m
    root[:, 1] -= lowered
    locked, short = _reach_targets(motion, legs, targets, root)
    missed = (short > _REACHED_M) & contacts.down.T
    return LockedFeet(
        locked,
        mean_slide_m_s(legs.balls_m(positions, world), contacts),
        mean_slide_m_s(legs.balls_m(*locked.world()), contacts),
        float(lowered.max()),
        int(missed.sum()),
        float(lift_m.max()),
    )


def _lift_m(
    positions_m: FloatArray,
    world: FloatArray,
    legs: Legs,
    shifts_m: FloatArray,
    level_m: float,
    rate_hz: float,
    limits: LockLimits,
) -> FloatArray:
    """Return by how much each foot is lifted, (2, N), so that it stays above flat ground."""
    lowest_m = np.stack([leg.lowest_m(positions_m, world) for leg in legs.both])
    above_m = lowest_m + shifts_m[..., 1] - level_m
    lifts = [clearance_m(one, rate_hz, allowed_m=limits.sunk_m) for one in above_m]
    return np.stack(lifts)


def _hip_lowering(
    positions_m: FloatArray, legs: Legs, targets_m: FloatArray, deepest_m: float, reach: int
) -> FloatArray:
    """Return the distance by which the hips are lowered, (N,), so that both legs reach.

    It is smooth and at most `deepest_m`.
    """
    from scipy.ndimage import maximum_filter1d  # slow to import

    need = np.zeros(len(positions_m))
    for leg, target in zip(legs.both, targets_m, strict=True):
        hip, knee, ankle = (positions_m[:, j] for j in (leg.thigh, leg.shin, leg.foot))
        a, b, now = (np.linalg.norm(v, axis=1) for v in (knee - hip, ankle - knee, ankle - hip))
        longest = longest_m(a, b, now)
        away = np.linalg.norm((target - hip)[:, [0, 2]], axis=1)
        drop = hip[:, 1] - target[:, 1] - np.sqrt(np.maximum(longest**2 - away**2, 0.0))
        need = np.maximum(need, drop)
    # A mean over the span of a running maximum is smooth, and never below what is needed.
    widened = maximum_filter1d(np.clip(need, 0.0, deepest_m), 2 * reach + 1, mode="nearest")
    return _smooth(widened, reach)


def _smooth(values: FloatArray, reach: int) -> FloatArray:
    """Apply the mean over nearby frames twice, `reach` frames on either side in total."""
    from scipy.ndimage import uniform_filter1d  # slow to import

    span = 2 * (reach // 2) + 1
    once = uniform_filter1d(values, span, mode="nearest")
    return np.asarray(uniform_filter1d(once, span, mode="nearest"))


def _reach_targets(
    motion: RigMotion, legs: Legs, targets_m: FloatArray, root_m: FloatArray
) -> tuple[RigMotion, FloatArray]:
    """Return the movement with the ankles at their targets, and each foot's shortfall, (2, N)."""
    positions, world = to_world(motion.rig, root_m, motion.rotations)
    right = positions[:, legs.right.thigh] - positions[:, legs.left.thigh]
    short = np.empty(targets_m.shape[:2])
    result = world.copy()
    for foot, leg in enumerate(legs.both):
        hip, knee, ankle = (positions[:, joint] for joint in (leg.thigh, leg.shin, leg.foot))
        reach = reach_for(hip, knee, ankle, targets_m[foot], right)
        _turn(result, motion.rig, leg, reach)
        short[foot] = reach.short_m
    rotations = to_local(motion.rig, result)
    return RigMotion(motion.rig, motion.rate_hz, root_m, rotations, motion.observed), short


def _turn(world: FloatArray, rig: Rig, leg: Leg, reach: Reach) -> None:
    """Turn the thigh and the shin, each with the joints attached to it, in place.

    The foot and the joints below it keep their world rotation.
    """
    for joint in range(leg.thigh, rig.joint_count):
        part = _nearest(rig, joint, (leg.thigh, leg.shin, leg.foot))
        if part == leg.thigh:
            world[:, joint] = multiply(reach.thigh_turns, world[:, joint])
        elif part == leg.shin:
            world[:, joint] = multiply(reach.shin_turns, world[:, joint])


def _nearest(rig: Rig, joint: int, parts: tuple[int, ...]) -> int:
    """Return the first of `parts` from a joint (inclusive) up to the root; -1 if there is none."""
    while joint >= 0 and joint not in parts:
        joint = rig.parents[joint]
    return joint
