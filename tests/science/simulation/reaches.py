"""Reaches of simulated participants in the open, and what is measured of them."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray
from app.science.simulation import Goal, GoalKind, MovementTraits, SimulatedParticipant
from tests.science.simulation.people import RATE_HZ, person_of, tip

NOISY = MovementTraits(patience_s=60.0)


def touch(x: float, y: float = 1.25, near_m: float = 0.05) -> Goal:
    """Return a goal to touch a point in the open, which has no way in."""
    return Goal(GoalKind.REACH, "RightHand", (x, y, -0.45), near_m)


def reached(
    person: SimulatedParticipant, goal: Goal, start_s: float, for_s: float, late_s: float = 0.0
) -> FloatArray:
    """Return the finger tip (N, 3) on its way; the person sees it late by `late_s`."""
    tips: list[FloatArray] = []
    late = round(late_s * RATE_HZ)
    for frame in range(round(for_s * RATE_HZ)):
        t_s = start_s + frame / RATE_HZ
        tips.append(tip(person.pose(t_s, goal), "Right"))
        x, y, z = tips[max(0, frame - late)].tolist()
        person.see(t_s, "RightHand", (x, y, z))
    return np.array(tips)


@dataclass(frozen=True)
class Reach:
    """One reach of 40 cm.

    Attributes:
        speed_m_s: (N,) from where it exceeds 5 % of its peak to where it last does.
        peak: the frame of the peak in `speed_m_s`.
        half_share: time above half the peak's speed, as a share of twice the time to the peak.
        peak_share: when the peak is, as a share of the time above half its speed.
        deviation: largest distance from the straight line, as a share of its length.
    """

    speed_m_s: FloatArray
    peak: int
    half_share: float
    peak_share: float
    deviation: float


def reach_of(seed: int) -> Reach:
    """Let one person reach from the left to the right, and measure it."""
    person = person_of(seed, NOISY)
    reached(person, touch(-0.2), 0.0, 2.0)
    way = reached(person, touch(0.2), 2.0, 2.0)
    speed = np.linalg.norm(np.diff(way, axis=0), axis=1) * RATE_HZ
    moving = np.flatnonzero(speed > 0.05 * speed.max())
    first, last = int(moving[0]), int(moving[-1])
    peak = int(speed.argmax())
    half = np.flatnonzero(speed > 0.5 * speed.max())
    chord = way[half[-1]] - way[half[0]]
    along = np.outer((way - way[half[0]]) @ chord / (chord @ chord), chord)
    off = np.linalg.norm(way - way[half[0]] - along, axis=1)[half[0] : half[-1]]
    return Reach(
        speed[first:last],
        peak - first,
        float((half[-1] - half[0]) / (2.0 * (peak - first) + 1e-9)),
        float((peak - half[0]) / max(half[-1] - half[0], 1)),
        float(off.max() / np.linalg.norm(chord)),
    )


def fitts_slope_s_per_bit(people: int = 6) -> float:
    """Return the slope of the time to hit over the index of difficulty (Shannon's form)."""
    bits, times_s = zip(*_hits(people), strict=True)
    return float(np.polyfit(bits, times_s, 1)[0])


def _hits(people: int) -> Iterator[tuple[float, float]]:
    """Yield index of difficulty and time from setting off until the tip stays in the target."""
    for seed in range(people):
        for near_m in (0.015, 0.03, 0.06):
            for reach_m in (0.15, 0.4):
                person = person_of(seed, NOISY)
                reached(person, touch(-0.1), 0.0, 1.6)
                goal = touch(-0.1 + reach_m, near_m=near_m)
                way = reached(person, goal, 1.6, 2.6)
                away = np.linalg.norm(way - np.array(goal.target_m), axis=1)
                began = int(np.flatnonzero(np.linalg.norm(way - way[0], axis=1) > 0.01)[0])
                inside = int(np.flatnonzero(away > 1.5 * near_m)[-1]) + 1
                yield float(np.log2(reach_m / (2.0 * near_m) + 1.0)), (inside - began) / RATE_HZ
