"""Feet that stay where they stand.

An avatar with the person's proportions walks without sliding at any size. With another thigh:shin
ratio the same joint angles carry the foot elsewhere, and it slides while it should stand. Locking
holds each foot, during each contact of the *source*, at one place:

    c(t) = (mean x, ground there, mean z) - (x, y, z)(t) of the sole below the ball,
    ankle(t) = unlocked ankle(t) + c(t).

Between two contacts c passes smoothly from the end of one to the start of the next, before the
first and after the last it stays, so nothing pops. Feet keep their orientation, so they still roll
from heel to toe, and legs reach for the ankles (`leg_reach`). The body rises and sinks with its
feet: the hips take the smoothed mean of both corrections' heights, and so follow a ground that the
capture never saw. Where a leg is then too short the hips come down a little, by a limited amount;
what is still out of reach is let go: the leg points to its place as far as it goes, and the frames
are counted.
"""

from dataclasses import dataclass

import numpy as np

from app.science.retargeting.contacts import Contacts, mean_slide_m_s
from app.science.retargeting.foot_holding import held_shifts
from app.science.retargeting.ground import Flat, Ground
from app.science.retargeting.joint_map import JointMap
from app.science.retargeting.leg_reach import Reach, longest_m, reach_for
from app.science.retargeting.legs import Leg, Legs, legs_of
from app.science.rig import Rig, RigError, RigMotion, place, to_local
from app.science.rotations import FloatArray, multiply

_FLAT = Flat()
# Shorter than this no eye sees a foot miss its place.
_REACHED_M = 1e-3


@dataclass(frozen=True)
class LockLimits:
    """How a foot is held.

    Attributes:
        smoothing_s: over how long the hips' rise and fall is smoothed, either way.
        settling_s: how long a foot takes to take up its own speed again beside a contact.
        deepest: by how many leg lengths the hips may come down to let both feet reach.
    """

    smoothing_s: float = 0.2
    settling_s: float = 0.15
    deepest: float = 0.04


_DEFAULT = LockLimits()


@dataclass(frozen=True, eq=False)
class LockedFeet:
    """A movement with its feet held, and what it took.

    Attributes:
        motion: the movement.
        slide_before_m_s, slide_after_m_s: mean horizontal speed of feet in contact; None without
            any contact.
        lowered_m: by how much the hips came down at most to let the legs reach.
        out_of_reach: frames in which a foot in contact could not reach its place, both feet added.
    """

    motion: RigMotion
    slide_before_m_s: float | None
    slide_after_m_s: float | None
    lowered_m: float
    out_of_reach: int


def lock_feet(
    motion: RigMotion,
    joint_map: JointMap,
    contacts: Contacts,
    ground: Ground = _FLAT,
    limits: LockLimits = _DEFAULT,
) -> LockedFeet:
    """Hold the feet of an avatar at their places while the source's are down.

    Args:
        motion: the avatar's movement, after the transfer.
        joint_map: the avatar's.
        contacts: of the source, `find_contacts`, as many frames.
        ground: under the avatar.
        limits: of the correction.

    Raises:
        RigError: the legs are not mapped, or the contacts have another number of frames.
    """
    legs = legs_of(motion.rig, joint_map)
    if len(contacts.down) != motion.frame_count:
        raise RigError(
            f"{len(contacts.down)} frames of contacts do not fit {motion.frame_count} of movement."
        )
    positions, world = motion.world()
    shifts = held_shifts(positions, world, legs, contacts, ground, limits.settling_s)
    reach = max(1, round(limits.smoothing_s * motion.rate_hz))
    raise_m = np.zeros((motion.frame_count, 3))
    raise_m[:, 1] = _smooth(shifts[..., 1].mean(axis=0), reach)
    targets = shifts + np.stack([positions[:, leg.foot] for leg in legs.both])
    raised = positions + raise_m[:, np.newaxis]
    lowered = _lowered(raised, legs, targets, limits.deepest * legs.length_m, reach)
    root = motion.root_positions_m + raise_m
    root[:, 1] -= lowered
    locked, short = _reached(motion, legs, targets, root)
    missed = (short > _REACHED_M) & contacts.down.T
    return LockedFeet(
        locked,
        mean_slide_m_s(legs.balls_m(positions, world), contacts),
        mean_slide_m_s(legs.balls_m(*locked.world()), contacts),
        float(lowered.max()),
        int(missed.sum()),
    )


def _lowered(
    positions_m: FloatArray, legs: Legs, targets_m: FloatArray, deepest_m: float, reach: int
) -> FloatArray:
    """(N,) by how much the hips come down so that both legs reach, smoothly and not too deep."""
    from scipy.ndimage import maximum_filter1d  # slow to load

    need = np.zeros(len(positions_m))
    for leg, target in zip(legs.both, targets_m, strict=True):
        hip, knee, ankle = (positions_m[:, j] for j in (leg.thigh, leg.shin, leg.foot))
        a, b, now = (np.linalg.norm(v, axis=1) for v in (knee - hip, ankle - knee, ankle - hip))
        longest = longest_m(a, b, now)
        away = np.linalg.norm((target - hip)[:, [0, 2]], axis=1)
        drop = hip[:, 1] - target[:, 1] - np.sqrt(np.maximum(longest**2 - away**2, 0.0))
        need = np.maximum(need, drop)
    # A mean over the span of a running maximum is smooth, and nowhere below what is needed.
    widened = maximum_filter1d(np.clip(need, 0.0, deepest_m), 2 * reach + 1, mode="nearest")
    return _smooth(widened, reach)


def _smooth(values: FloatArray, reach: int) -> FloatArray:
    """Twice the mean over nearby frames, `reach` on either side in all."""
    from scipy.ndimage import uniform_filter1d  # slow to load

    span = 2 * (reach // 2) + 1
    once = uniform_filter1d(values, span, mode="nearest")
    return np.asarray(uniform_filter1d(once, span, mode="nearest"))


def _reached(
    motion: RigMotion, legs: Legs, targets_m: FloatArray, root_m: FloatArray
) -> tuple[RigMotion, FloatArray]:
    """The movement whose ankles are at their targets, and (2, N) by how much they fall short."""
    positions, world = place(motion.rig, root_m, motion.rotations)
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
    """Turn the thigh with what hangs on it, and the shin, in place; the foot keeps its own way."""
    for joint in range(leg.thigh, rig.joint_count):
        part = _nearest(rig, joint, (leg.thigh, leg.shin, leg.foot))
        if part == leg.thigh:
            world[:, joint] = multiply(reach.thigh_turns, world[:, joint])
        elif part == leg.shin:
            world[:, joint] = multiply(reach.shin_turns, world[:, joint])


def _nearest(rig: Rig, joint: int, parts: tuple[int, ...]) -> int:
    """The first of `parts` on the way from a joint to the root, itself included; -1 for none."""
    while joint >= 0 and joint not in parts:
        joint = rig.parents[joint]
    return joint
