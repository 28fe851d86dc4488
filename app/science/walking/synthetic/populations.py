"""Made-up walkers, to try the model where the truth is known. Their walks are marked synthetic.

They are not made by the planner's agents, which the model would fit too easily:

    shape     the scene's shortest way, its corners rounded, bowed to one side, ends not quite met,
              with the sway of steps from side to side
    pace      a person's own cruising speed, reached the less the shorter the walk is, v = c (1 -
              exp(-d / b)), as people do (Carlisle and Kuo 2023, b = 1.9 m); ramps of minimum jerk
              (Flash and Hogan 1985) up and down
    turns     slower by the one-third power of curvature (Lacquaniti et al. 1983)
    people    cruising speed, ramps, stature and sway differ between people, and a little from walk
              to walk of one person

The populations differ in stated ways; none is a sample of real people.
"""

from dataclasses import dataclass

import numpy as np

from app.science.rotations import FloatArray
from app.science.walking.records import PlannedPath, Track, arc_of
from app.science.walking.scene import SPACING_M, by_length

RATE_HZ, STANDING_S = 60.0, 0.75
SLOWING_PER_M = 2.0
"""Curvature at which the slow-down by turns sets in, 1/m."""


@dataclass(frozen=True)
class Population:
    """How a population walks; "sd" is between people, "within" from walk to walk of one.

    Attributes:
        name, about: key, and how it differs from others.
        speed_m_s, speed_sd, speed_within: cruising speed; within as a share of it.
        second_speed_m_s: half of the people have this one instead, where it is not None.
        speed_per_stature: m/s more for each metre of stature above the mean.
        ramp_s, ramp_sd, ramp_within: time from rest to cruising, within as a share.
        reach_m: b of the speed over distance.
        turn_exponent: of the slow-down in turns; 1/3 in people.
        stature_m, stature_sd: body heights.
        sway_m: half of the width of the sway from side to side.
    """

    name: str
    about: str
    speed_m_s: float = 1.35
    speed_sd: float = 0.13
    speed_within: float = 0.06
    second_speed_m_s: float | None = None
    speed_per_stature: float = 0.2
    ramp_s: float = 0.9
    ramp_sd: float = 0.12
    ramp_within: float = 0.08
    reach_m: float = 1.9
    turn_exponent: float = 1.0 / 3.0
    stature_m: float = 1.78
    stature_sd: float = 0.07
    sway_m: float = 0.018


POPULATIONS = (
    Population("students", "young, alike, brisk; the paper's own mix of statures"),
    Population(
        "older",
        "slow, with long ramps and wide sway, unlike each other",
        speed_m_s=1.05,
        speed_sd=0.18,
        ramp_s=1.2,
        ramp_sd=0.2,
        stature_m=1.70,
        sway_m=0.03,
    ),
    Population(
        "workers",
        "in a hurry: fast, short ramps, the same each time",
        speed_m_s=1.6,
        speed_sd=0.10,
        speed_within=0.04,
        ramp_s=0.7,
        ramp_sd=0.08,
        reach_m=1.5,
    ),
    Population(
        "tall and short",
        "speed goes by stature, which differs much",
        speed_sd=0.05,
        speed_per_stature=1.2,
        stature_sd=0.12,
    ),
    Population(
        "unsteady",
        "people alike, but each walks differently every time, and slows down much in turns",
        speed_m_s=1.2,
        speed_sd=0.06,
        speed_within=0.15,
        ramp_within=0.2,
        turn_exponent=0.5,
    ),
    Population(
        "two habits",
        "half stroll and half stride, nobody is average",
        speed_m_s=1.05,
        speed_sd=0.06,
        second_speed_m_s=1.5,
    ),
)


@dataclass(frozen=True)
class Person:
    """One of a population."""

    name: str
    population: Population
    speed_m_s: float
    ramp_s: float
    stature_m: float
    sway_m: float
    rounding_m: float


def person_of(population: Population, number: int, rng: np.random.Generator) -> Person:
    """Make a person; `number` only names them."""
    p = population
    stature = float(np.clip(p.stature_m + p.stature_sd * rng.standard_normal(), 1.45, 2.1))
    middle = p.speed_m_s
    if p.second_speed_m_s is not None and number % 2:
        middle = p.second_speed_m_s
    speed = middle + p.speed_sd * rng.standard_normal()
    speed += p.speed_per_stature * (stature - p.stature_m)
    ramp = p.ramp_s + p.ramp_sd * rng.standard_normal()
    return Person(
        f"{p.name} {number:02d}",
        p,
        float(np.clip(speed, 0.5, 1.95)),
        float(np.clip(ramp, 0.35, 2.5)),
        stature,
        float(p.sway_m * rng.lognormal(0.0, 0.3)),
        float(rng.uniform(0.12, 0.3)),
    )


def walk_along(person: Person, path: PlannedPath, rng: np.random.Generator) -> Track:
    """Let a person walk a path once, standing a little before and after.

    Args:
        person: who.
        path: the scene's shortest way; only its course is used.
        rng: of everything that differs from walk to walk.
    """
    line = _course(person, path, rng)
    arc = arc_of(line)
    speeds = _speeds(person, line, arc, rng)
    # Between two points of the line at the mean of their speeds: both ends are at rest.
    steps_s = np.diff(arc) / ((speeds[1:] + speeds[:-1]) / 2.0)
    passed_s = np.concatenate([[0.0], np.cumsum(steps_s)])
    count = int(np.ceil((passed_s[-1] + 2 * STANDING_S) * RATE_HZ)) + 1
    times_s = np.arange(count) / RATE_HZ
    xy_m = np.stack(
        [np.interp(times_s - STANDING_S, passed_s, line[:, axis]) for axis in (0, 1)], axis=-1
    )
    return Track(times_s, xy_m, person.name, person.population.name, "synthetic", person.stature_m)


def _course(person: Person, path: PlannedPath, rng: np.random.Generator) -> FloatArray:
    """The line on the floor: rounded, bowed and swaying."""
    from scipy.ndimage import gaussian_filter1d

    even = by_length(path.points_m, SPACING_M)
    rounded = gaussian_filter1d(even, person.rounding_m / SPACING_M, axis=0, mode="nearest")
    # The filter moves the ends inwards: the ends' shifts are faded out along the line.
    share = np.linspace(0.0, 1.0, len(even))[:, None]
    rounded += (1.0 - share) ** 4 * (even[0] - rounded[0]) + share**4 * (even[-1] - rounded[-1])
    rounded = by_length(rounded, SPACING_M)
    along = np.gradient(rounded, axis=0)
    along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-12)
    aside = np.stack([-along[:, 1], along[:, 0]], axis=-1)
    way = np.linspace(0.0, 1.0, len(rounded))
    bow = 0.012 * path.length_m * rng.standard_normal() * np.sin(np.pi * way)
    steps = path.length_m / rng.uniform(1.2, 1.5)
    sway = np.sin(2.0 * np.pi * (steps * way + rng.random())) * np.sin(np.pi * way)
    return by_length(rounded + (bow + person.sway_m * sway)[:, None] * aside, SPACING_M)


def _speeds(
    person: Person, line: FloatArray, arc: FloatArray, rng: np.random.Generator
) -> FloatArray:
    """Speed at each point of the line."""
    from scipy.ndimage import gaussian_filter1d

    p, length = person.population, float(arc[-1])
    cruising = person.speed_m_s * rng.lognormal(0.0, p.speed_within)
    ramp_s = person.ramp_s * rng.lognormal(0.0, p.ramp_within)
    peak = cruising * (1.0 - np.exp(-length / p.reach_m))
    # A ramp of minimum jerk covers half of peak times ramp; a short walk is all ramps.
    ramp_s = min(ramp_s, length / peak)
    share = np.linspace(0.0, 1.0, 200)
    pace = 10.0 * share**3 - 15.0 * share**4 + 6.0 * share**5
    covered = peak * ramp_s * (2.5 * share**4 - 3.0 * share**5 + share**6)
    up, down = np.interp(arc, covered, pace), np.interp(length - arc, covered, pace)
    speeds = np.maximum(peak * np.minimum(up, down), 0.01)
    heading = np.unwrap(np.arctan2(*np.gradient(line, axis=0).T[::-1]))
    curved = np.abs(gaussian_filter1d(np.gradient(heading, arc), 8.0, mode="nearest"))
    slowed: FloatArray = speeds * (1.0 + curved / SLOWING_PER_M) ** -p.turn_exponent
    return slowed
