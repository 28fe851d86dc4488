"""Synthetic people whose hands move with a planted tempo, and reaches of the agent itself."""

from dataclasses import dataclass

import numpy as np

from app.science.reaching import HandTrack, Reach, Reacher, ReachRules, cut_agents
from app.science.simulation import skewed_jerk, usual_time_s

RATE_HZ = 90.0
NEAR_M = 0.05
STILL_M_S = ReachRules().still_m_s


@dataclass(frozen=True)
class Planted:
    """Somebody who reaches with a tempo of their own.

    Attributes:
        tempo: median time over the simulation's assumed time.
        spread: SD of the logarithm of single times.
        skew: of all movements.
    """

    tempo: float
    spread: float = 0.08
    skew: float = 1.0


def hand_of(
    planted: Planted,
    who: Reacher,
    rng: np.random.Generator,
    *,
    count: int = 20,
    distances_m: tuple[float, float] = (0.15, 0.7),
) -> HandTrack:
    """Let somebody reach to and fro, with rests, a slight arc and noise of 0.2 mm."""
    near_m = NEAR_M if who.width_m is None else who.width_m / 2.0
    here = np.array([0.1, 1.2, -0.3])
    places = [here] * 45
    for _ in range(count):
        distance_m = float(rng.uniform(*distances_m))
        ahead = rng.standard_normal(3)
        ahead /= np.linalg.norm(ahead)
        aside = np.cross(ahead, [0.3, 0.8, 0.5])
        lasts_s = planted.tempo * usual_time_s(distance_m, near_m)
        lasts_s *= float(np.exp(planted.spread * rng.standard_normal()))
        for at in range(round(lasts_s * RATE_HZ)):
            share = skewed_jerk(at / (lasts_s * RATE_HZ), planted.skew)
            arc = 0.05 * distance_m * np.sin(np.pi * share)
            places.append(here + share * distance_m * ahead + arc * aside)
        here = here + distance_m * ahead
        places += [here] * round(float(rng.uniform(0.3, 0.6)) * RATE_HZ)
    positions = np.array(places) + 0.0002 * rng.standard_normal((len(places), 3))
    return HandTrack(np.arange(len(places)) / RATE_HZ, positions, "right", who)


def as_tracker_file(track: HandTrack) -> str:
    """Return a track as a tracker file of UXF, in which a right hand moves without turning."""
    axes = [f"right_{kind}_{axis}" for kind in ("pos", "rot") for axis in "xyz"]
    rows = [
        f"{time_s:.4f},{x:.5f},{y:.5f},{z:.5f},10,20,30"
        for time_s, (x, y, z) in zip(track.times_s, track.positions_m, strict=True)
    ]
    return "\n".join([",".join(["time", *axes]), *rows]) + "\n"


def reach_of_the_agent(tempo: float, skew: float, distance_m: float = 0.4) -> Reach:
    """Return a reach of the simulation itself, cut as recordings are, and sampled densely."""
    lasts_s = np.array([tempo * usual_time_s(distance_m, NEAR_M)])
    agent = cut_agents(distance_m, lasts_s, np.array([skew]), STILL_M_S)
    times_s = np.linspace(0.0, float(agent.arrival_s[0]), 60)
    way = agent.covered_m(times_s)[0]
    return Reach(times_s, np.outer(way, [1.0, 0.0, 0.0]), "right", Reacher("somebody", "planted"))
