"""The agents and the metric in NumPy, with which the compiled forms must agree."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from app.science.rotations import FloatArray
from app.science.walking.following.course import Pace, Way
from app.science.walking.following.following import SteeringFollower
from app.science.walking.following.metrics import EuclideanMetric
from app.science.walking.records.protocols import Reference, Trajectories

IntArray = npt.NDArray[np.int64]


@dataclass(frozen=True)
class PlainFollower(SteeringFollower):
    """`SteeringFollower` in plain NumPy, without the compiler."""

    def _move(
        self, way: Way, vectors: FloatArray, pace: Pace, places: FloatArray, arrival: FloatArray
    ) -> None:
        move_all(way, vectors, pace, places, arrival)


@dataclass(frozen=True)
class PlainMetric(EuclideanMetric):
    """`EuclideanMetric` in plain NumPy, without the compiler."""

    def deviations(self, reference: Reference, trajectories: Trajectories) -> FloatArray:
        """Return the (K,) deviations of K agents from the reference walk."""
        apart = trajectories.xy_m - reference.xy_m
        sums = np.sqrt((apart * apart).sum(axis=-1)).sum(axis=-1)
        deviations: FloatArray = sums / reference.length_m
        return deviations


def _off(places: FloatArray, way: Way, legs: IntArray) -> tuple[FloatArray, FloatArray]:
    apart = places - way.points[legs]
    units = way.units[legs]
    along = apart[:, 0] * units[:, 0] + apart[:, 1] * units[:, 1]
    along = np.minimum(np.maximum(along, 0.0), way.lengths[legs])
    off_path = apart - along[:, None] * units
    return along, off_path[:, 0] * off_path[:, 0] + off_path[:, 1] * off_path[:, 1]


def _progress(
    places: FloatArray, way: Way, legs: IntArray, lookahead: float
) -> tuple[IntArray, FloatArray]:
    last = len(way.lengths) - 1
    along, apart = _off(places, way, legs)
    going = np.ones(len(legs), dtype=np.bool_)
    for _ in range(last):
        following = np.minimum(legs + 1, last)
        next_along, next_apart = _off(places, way, following)
        going = going & (legs < last) & (way.lengths[legs] - along <= lookahead)
        going = going & ~(next_apart > apart)
        legs = np.where(going, following, legs)
        along, apart = np.where(going, next_along, along), np.where(going, next_apart, apart)
    return legs, along


def _aim(way: Way, legs: IntArray, ahead: FloatArray) -> FloatArray:
    last = len(way.lengths) - 1
    for _ in range(last):
        on = (legs < last) & (way.before[np.minimum(legs + 1, last)] < ahead)
        legs = np.where(on, legs + 1, legs)
    along = np.minimum(ahead - way.before[legs], way.lengths[legs])
    aim: FloatArray = way.points[legs] + along[:, None] * way.units[legs]
    return aim


def _turned(heading: FloatArray, desired: FloatArray, most: FloatArray) -> FloatArray:
    (hx, hy), (dx, dy) = heading.T, desired.T
    distance = np.sqrt(dx * dx + dy * dy)
    there = distance < 1e-9
    dx, dy = dx / np.where(there, 1.0, distance), dy / np.where(there, 1.0, distance)
    half = most * 0.5
    half = half + half * half * half / 3.0
    scale = 1.0 / (1.0 + half * half)
    cosine, sine = (1.0 - half * half) * scale, 2.0 * half * scale
    sine = np.where(hx * dy - hy * dx < 0.0, -sine, sine)
    facing = hx * dx + hy * dy >= cosine
    x = np.where(facing, dx, hx * cosine - hy * sine)
    y = np.where(facing, dy, hx * sine + hy * cosine)
    return np.where(there[:, None], heading, np.stack([x, y], axis=-1))


def _left(places: FloatArray, way: Way, legs: IntArray) -> FloatArray:
    apart = way.points[legs + 1] - places
    distance = np.sqrt(apart[:, 0] * apart[:, 0] + apart[:, 1] * apart[:, 1])
    left: FloatArray = distance + (way.before[-1] - way.before[legs + 1])
    return left


def move_all(
    way: Way, vectors: FloatArray, pace: Pace, places: FloatArray, arrival: FloatArray
) -> None:
    """Move K agents; fill `places` (K, N, 2) and `arrival` (K,) from vectors (K, 3)."""
    fastest, change, slope = vectors[:, 0], vectors[:, 1] * pace.dt, vectors[:, 2] * pace.dt
    count, samples = places.shape[:2]
    at = np.tile(way.points[0], (count, 1))
    heading, speed = np.tile(way.units[0], (count, 1)), np.full(count, pace.begin)
    legs, last = np.zeros(count, dtype=np.int64), np.full(count, len(way.lengths) - 1)
    apart, moving = _left(at, way, last), np.ones(count, dtype=np.bool_)
    places[:, 0] = at
    for step in range(1, pace.steps + 1):
        legs, along = _progress(at, way, legs, pace.lookahead)
        aim = _aim(way, legs, way.before[legs] + along + pace.lookahead)
        heading = _turned(heading, aim - at, slope * speed)
        desired = fastest
        if pace.brakes:
            room = np.maximum(_left(at, way, legs) - 0.5 * speed * pace.dt, 0.0)
            stops = np.sqrt(0.25 * change * change + 2.0 * vectors[:, 1] * room) - 0.5 * change
            desired = np.minimum(fastest, stops)
        old = speed
        speed = speed + np.minimum(np.maximum(desired - speed, -change), change)
        speed = np.maximum(pace.floor, speed)
        stride = 0.5 * (old + speed) * pace.dt
        at = np.where(moving[:, None], at + stride[:, None] * heading, at)
        if step < samples:
            places[:, step] = at
        before, apart = apart, _left(at, way, last)
        came = moving & (apart <= pace.radius)
        arrival[came] = _interpolated(step, before[came], apart[came], pace)
        moving = moving & ~came
        if not moving.any() or step == pace.steps:
            places[:, step + 1 :] = at[:, None]
            return


def _interpolated(step: int, before: FloatArray, apart: FloatArray, pace: Pace) -> FloatArray:
    outside = before > pace.radius
    way = np.where(outside, before - apart, 1.0)
    share = np.where(outside, (before - pace.radius) / way, 0.0)
    time_s: FloatArray = (step - 1 + share) * pace.dt
    return time_s
