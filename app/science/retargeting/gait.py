"""Measures of a walk: the paths of the balls of the feet, lifts, strides, steps, and foot slide.

The paper rates a retargeted walk by its figure 9: the main toe joint's forward against its vertical
movement. A *lift* is one arc in that figure: the ball leaves the ground, swings and comes down.

A *stride* leads from one contact of a foot to the next contact of the same foot, and a *step* from
a contact of one foot to the next contact of the other, as gait analysis uses the words: two steps
make a stride. Both are measured between the middles of the contacts, where the balls rest. The
paper's figure 9 shows strides, which it calls step sizes (110, 150 and 165 cm). The *step height*
of a stride is the range from the ball's lowest to its highest position on the way (16, 20 and 22
cm).

Source: Degen et al. (2022), section 4 and figure 9.

Lengths are along the walk. The direction of travel d(t) is that of the hips, smoothed over half a
stride so that their sway from foot to foot is left out; where they hardly move, the direction of
the nearest moving frame is used, and for a body that never travels the direction it faces. A point
p has travelled

    forward(t) = (p(0) - hips(0)) . d(0) + integral of p' . d dt,

which is plain distance on a straight walk and distance along the path on a curved one. All of it
scales with the body.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from app.science.retargeting.contacts import Contacts, contacts_of, mean_slide_m_s
from app.science.retargeting.ground import Flat, Ground
from app.science.retargeting.legs import Legs, Side
from app.science.rig import RigMotion
from app.science.rotations import FloatArray

_FLAT = Flat()
# In leg lengths: a foot that rises less is shifted along the ground, not lifted.
_LOWEST_LIFT = 0.02


@dataclass(frozen=True)
class Stride:
    """One lift of a foot, from its contact to its next contact.

    Attributes:
        side: whether it is the left or the right foot.
        lift_s, contact_s: times at which the foot leaves the ground and comes down, from the first
            frame.
        length_m: forward travel of the ball from contact to contact.
        height_m: difference in height between its lowest and its highest position on the way.
        contact_height_m: the height of the ball above the ground at contact.
    """

    side: Side
    lift_s: float
    contact_s: float
    length_m: float
    height_m: float
    contact_height_m: float


@dataclass(frozen=True, eq=False)
class FootPath:
    """The path of the ball of one foot.

    Attributes:
        side: whether it is the left or the right foot.
        forward_m: (N,) distance along the direction of travel.
        height_m: (N,) height above the ground.
    """

    side: Side
    forward_m: FloatArray
    height_m: FloatArray

    @property
    def start_height_m(self) -> float:
        """Height of the ball above the ground in the first frame."""
        return float(self.height_m[0])


@dataclass(frozen=True, eq=False)
class Walk:
    """The measures of one body's walk.

    Attributes:
        rate_hz: frames per second.
        leg_length_m: thigh plus shin.
        thigh_share: thigh over thigh plus shin, the mean of both legs.
        feet: the paths of the left and the right foot.
        contacts: the times at which the feet are down.
        strides: whole lifts in the order of their start; lifts cut off by the capture are left out.
        step_lengths_m: forward distance from each whole contact to the next one, of the other foot,
            in the order of time; contacts cut off by the capture count from where they are seen.
        slide_m_s: mean horizontal speed of feet in contact; None without contact.
    """

    rate_hz: float
    leg_length_m: float
    thigh_share: float
    feet: tuple[FootPath, FootPath]
    contacts: Contacts
    strides: tuple[Stride, ...]
    step_lengths_m: tuple[float, ...]
    slide_m_s: float | None

    @property
    def mean_stride_length_m(self) -> float | None:
        """Mean length of the strides; None without a whole stride."""
        return _mean([stride.length_m for stride in self.strides])

    @property
    def mean_step_length_m(self) -> float | None:
        """Mean length of the steps; None without a step."""
        return _mean(list(self.step_lengths_m))

    @property
    def mean_step_height_m(self) -> float | None:
        """Mean height of the lifts; None without a whole stride."""
        return _mean([stride.height_m for stride in self.strides])

    def mean_step_height_of_m(self, side: Side) -> float | None:
        """Mean height of one side's lifts; None without a whole stride of it."""
        return _mean([stride.height_m for stride in self.strides if stride.side == side])


def walk_figures(
    motion: RigMotion,
    legs: Legs,
    ground: Ground = _FLAT,
    contacts: Contacts | None = None,
) -> Walk:
    """Measure a walk.

    Args:
        motion: the movement of a body with legs.
        legs: the leg joints of the body, from `legs_of`.
        ground: the ground under the body; heights are measured from it.
        contacts: the contacts of another body with the same movement, to measure the same stretches
            of time; None to detect this body's own. With the other body's contacts every lift
            counts, whatever its height here.
    """
    positions, world = motion.world()
    balls, hips = legs.balls_m(positions, world), positions[:, legs.hips]
    travel = directions(motion, positions, legs)
    lowest = _LOWEST_LIFT * legs.length_m if contacts is None else 0.0
    used_contacts = contacts or contacts_of(balls, legs.length_m, motion.rate_hz)
    feet, strides = [], []
    for foot, (leg, ball) in enumerate(zip(legs.both, balls, strict=True)):
        above = ball[:, 1] - ground.height_m(ball[:, 0], ball[:, 2])
        path = FootPath(leg.side, forward_m(ball, hips, travel), above)
        feet.append(path)
        strides += _strides(path, ball[:, 1], used_contacts.intervals(foot), motion.rate_hz, lowest)
    return Walk(
        rate_hz=motion.rate_hz,
        leg_length_m=legs.length_m,
        thigh_share=(legs.left.thigh_share + legs.right.thigh_share) / 2.0,
        feet=(feet[0], feet[1]),
        contacts=used_contacts,
        strides=tuple(sorted(strides, key=lambda stride: (stride.lift_s, stride.side))),
        step_lengths_m=_step_lengths_m(feet, used_contacts),
        slide_m_s=mean_slide_m_s(balls, used_contacts),
    )


def _step_lengths_m(feet: list[FootPath], contacts: Contacts) -> tuple[float, ...]:
    """Return the lengths of all steps: from each contact to the next one, if of the other foot."""
    middles = sorted(
        (sum(interval) // 2, foot) for foot in (0, 1) for interval in contacts.intervals(foot)
    )
    return tuple(
        float(feet[foot].forward_m[after] - feet[other].forward_m[before])
        for (before, other), (after, foot) in pairwise(middles)
        if foot != other
    )


def _strides(
    path: FootPath,
    ball_height_m: FloatArray,
    contacts: list[tuple[int, int]],
    rate_hz: float,
    lowest_m: float,
) -> list[Stride]:
    strides = []
    for before, after in pairwise(contacts):
        lift, contact = before[1], after[0]
        start, end = sum(before) // 2, sum(after) // 2
        arc = ball_height_m[start : end + 1]
        if float(arc.max()) - max(float(arc[0]), float(arc[-1])) < lowest_m:
            continue
        strides.append(
            Stride(
                side=path.side,
                lift_s=lift / rate_hz,
                contact_s=contact / rate_hz,
                length_m=float(path.forward_m[end] - path.forward_m[start]),
                height_m=float(np.ptp(arc)),
                contact_height_m=float(path.height_m[contact]),
            )
        )
    return strides


def _mean(values: list[float]) -> float | None:
    return float(np.mean(values)) if values else None


_SMOOTHING_S = 0.5
# In leg lengths per second: anything slower is not walking.
_SLOWEST_PER_S = 0.15


def directions(motion: RigMotion, positions_m: FloatArray, legs: Legs) -> FloatArray:
    """Return the unit horizontal direction of travel, (N, 3), for joint positions (N, J, 3)."""
    from scipy.ndimage import gaussian_filter1d  # slow to import

    facing = _facing(positions_m, legs)
    if motion.frame_count < 3:
        return facing
    hips = positions_m[:, legs.hips] * (1.0, 0.0, 1.0)
    velocity = np.gradient(hips, 1.0 / motion.rate_hz, axis=0)
    slow = gaussian_filter1d(velocity, _SMOOTHING_S * motion.rate_hz, axis=0, mode="nearest")
    speed = np.linalg.norm(slow, axis=1)
    moving = np.flatnonzero(speed > _SLOWEST_PER_S * legs.length_m)
    if not len(moving):
        return facing
    frames = np.arange(motion.frame_count)
    after = np.clip(np.searchsorted(moving, frames), 0, len(moving) - 1)
    before = np.maximum(after - 1, 0)
    nearer = np.abs(moving[after] - frames) <= np.abs(frames - moving[before])
    nearest = moving[np.where(nearer, after, before)]
    return np.asarray(slow[nearest] / speed[nearest, np.newaxis])


def forward_m(points_m: FloatArray, hips_m: FloatArray, travel: FloatArray) -> FloatArray:
    """Return how far points (N, 3) travel along directions (N, 3), relative to the hips' start."""
    start = float((points_m[0] - hips_m[0]) @ travel[0])
    steps = np.sum(np.diff(points_m, axis=0) * (travel[1:] + travel[:-1]) / 2.0, axis=1)
    return np.asarray(start + np.concatenate(([0.0], np.cumsum(steps))))


def _facing(positions_m: FloatArray, legs: Legs) -> FloatArray:
    """Return the horizontal direction that the body faces, (N, 3).

    It is perpendicular to the line between the hip joints, on the side of the toes.
    """
    right = positions_m[:, legs.right.thigh] - positions_m[:, legs.left.thigh]
    ahead = np.stack((right[:, 2], np.zeros(len(right)), -right[:, 0]), axis=1)
    length = np.linalg.norm(ahead, axis=1, keepdims=True)
    return np.where(length > 1e-9, ahead / np.maximum(length, 1e-9), (0.0, 0.0, -1.0))
