"""The agents of `following` and the distances of `metrics`, compiled.

Agents are simulated one after the other, each to its end.
"""

import math

import numpy as np

from app.science.compiled import compiled
from app.science.rotations import FloatArray
from app.science.walking.following.course import Pace, Way


@compiled
def _project_on_leg(x: float, y: float, way: Way, leg: int) -> tuple[float, float]:
    """Return a position's distance along a leg and its squared distance from the leg."""
    dx, dy = x - way.points[leg, 0], y - way.points[leg, 1]
    along = dx * way.units[leg, 0] + dy * way.units[leg, 1]
    along = min(max(along, 0.0), way.lengths[leg])
    ox, oy = dx - along * way.units[leg, 0], dy - along * way.units[leg, 1]
    return along, ox * ox + oy * oy


@compiled
def _progress(x: float, y: float, way: Way, leg: int, lookahead: float) -> tuple[int, float]:
    """Return the leg that the agent is on, and how far along it."""
    along, apart = _project_on_leg(x, y, way, leg)
    while leg + 1 < len(way.lengths) and way.lengths[leg] - along <= lookahead:
        next_along, next_apart = _project_on_leg(x, y, way, leg + 1)
        if next_apart > apart:
            break
        leg, along, apart = leg + 1, next_along, next_apart
    return leg, along


@compiled
def _aim(way: Way, leg: int, ahead: float) -> tuple[float, float]:
    """Return the point at a distance `ahead` along the path, at most its end."""
    while leg + 1 < len(way.lengths) and way.before[leg + 1] < ahead:
        leg += 1
    along = min(ahead - way.before[leg], way.lengths[leg])
    x = way.points[leg, 0] + along * way.units[leg, 0]
    return x, way.points[leg, 1] + along * way.units[leg, 1]


@compiled
def _turned(hx: float, hy: float, dx: float, dy: float, most: float) -> tuple[float, float]:
    """Return a heading (hx, hy) turned towards (dx, dy) by at most an angle, without trigonometry.

    tan(most / 2) is computed by its series: for an angle of a few hundredths of a radian the result
    is accurate to 1e-10.
    """
    distance = math.sqrt(dx * dx + dy * dy)
    if distance < 1e-9:
        return hx, hy
    dx, dy = dx / distance, dy / distance
    half = most * 0.5
    half = half + half * half * half / 3.0
    scale = 1.0 / (1.0 + half * half)
    cosine, sine = (1.0 - half * half) * scale, 2.0 * half * scale
    if hx * dx + hy * dy >= cosine:
        return dx, dy
    if hx * dy - hy * dx < 0.0:
        sine = -sine
    return hx * cosine - hy * sine, hx * sine + hy * cosine


@compiled
def _distance_left(x: float, y: float, way: Way, leg: int) -> float:
    """Return the remaining distance: to the leg's end and from there along the path."""
    dx, dy = way.points[leg + 1, 0] - x, way.points[leg + 1, 1] - y
    left: float = math.sqrt(dx * dx + dy * dy) + (way.before[-1] - way.before[leg + 1])
    return left


@compiled
def _braking_speed(left: float, speed: float, rate: float, dt: float) -> float:
    """Return the speed after this step from which braking ends within the remaining distance."""
    room, change = max(left - 0.5 * speed * dt, 0.0), rate * dt
    return math.sqrt(0.25 * change * change + 2.0 * rate * room) - 0.5 * change


@compiled
def move(way: Way, vector: FloatArray, pace: Pace, places: FloatArray) -> float:
    """Move one agent: fill `places` (N, 2) and return its arrival time, NaN without arrival."""
    fastest, change, slope = vector[0], vector[1] * pace.dt, vector[2] * pace.dt
    x, y = way.points[0, 0], way.points[0, 1]
    hx, hy = way.units[0, 0], way.units[0, 1]
    speed, leg = pace.begin, 0
    samples = len(places)
    apart = _distance_left(x, y, way, len(way.lengths) - 1)
    places[0, 0], places[0, 1] = x, y
    for step in range(1, pace.steps + 1):
        leg, along = _progress(x, y, way, leg, pace.lookahead)
        ax, ay = _aim(way, leg, way.before[leg] + along + pace.lookahead)
        hx, hy = _turned(hx, hy, ax - x, ay - y, slope * speed)
        target_speed = fastest
        if pace.brakes:
            target_speed = min(
                fastest, _braking_speed(_distance_left(x, y, way, leg), speed, vector[1], pace.dt)
            )
        before_speed = speed
        speed = max(pace.floor, speed + min(max(target_speed - speed, -change), change))
        stride = 0.5 * (before_speed + speed) * pace.dt
        x, y = x + stride * hx, y + stride * hy
        if step < samples:
            places[step, 0], places[step, 1] = x, y
        before, apart = apart, _distance_left(x, y, way, len(way.lengths) - 1)
        if apart <= pace.radius:
            for rest in range(step + 1, samples):
                places[rest, 0], places[rest, 1] = x, y
            share = (before - pace.radius) / (before - apart) if before > pace.radius else 0.0
            return (step - 1 + share) * pace.dt
        if step >= samples:
            # All samples are filled: stop an agent that is too far away to arrive in time.
            fastest_possible = max(max(speed, fastest), pace.floor)
            if apart - pace.radius > (pace.steps - step + 1) * fastest_possible * pace.dt:
                return np.nan
    for rest in range(pace.steps + 1, samples):
        places[rest, 0], places[rest, 1] = x, y
    return np.nan


@compiled
def move_all(
    way: Way, vectors: FloatArray, pace: Pace, places: FloatArray, arrival: FloatArray
) -> None:
    """Move K agents: vectors (K, 3); fill places (K, N, 2) and arrival (K,)."""
    for agent in range(len(vectors)):
        arrival[agent] = move(way, vectors[agent], pace, places[agent])


@compiled
def distance_sums(reference: FloatArray, places: FloatArray) -> FloatArray:
    """Return the sums (K,) over N samples of the distance between (N, 2) and each of (K, N, 2)."""
    sums = np.zeros(len(places))
    for agent in range(len(places)):
        for sample in range(len(reference)):
            dx = places[agent, sample, 0] - reference[sample, 0]
            dy = places[agent, sample, 1] - reference[sample, 1]
            sums[agent] += math.sqrt(dx * dx + dy * dy)
    return sums
