"""Measure how closely the avatar follows real people, and whether its delay is as set.

`tracking` tunes the product's own body and lets it follow a walk, a reach and a turn at 90 Hz with
nothing around it. It measures the difference of every driven axis from its clamped target, at most
1.5 deg on average and 5 deg at the 95th percentile, compared with the gains shipped with the
product and with welded hips; the difference from the person's movement, with the share caused by
the limits; and the share of frames that command more than 40 rad/s for some axis, which no target
may do. On a floor the body rests where contacts put it: figures of all samples, and of those
without contact, have no limit. `delay` sets 0, 125 and 350 ms and measures the achieved latency, at
most one frame off.

`floor` lets the body follow the six walks of `WALKS`, in place as `./run tune --capture` reads them
and travelling as captured, with nothing around it and on a floor. For each it states the errors
against the clamped and the unclamped targets in a row of `rows`: `capture`, `moves` ("in place" or
"travels"), `floor`, `against` ("clamped" or "unclamped"), `mean_deg`, `p95_deg`, `clipped_share`.

Needs the shared data; missing captures are left out.
"""

import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass, replace
from functools import cache
from pathlib import Path

import numpy as np

from app.science.avatar.configuration import Configuration
from app.science.avatar.mjcf import FLOOR_ONLY, Scene, avatar_model, default_configuration
from app.science.avatar.simulation import MAX_SPEED_RAD_S
from app.science.avatar.targets import TargetAngles, joint_rotations
from app.science.avatar.tuning import EMPTY_SPACE, Spread, follow_capture, track, tune
from app.science.latency import achieved_latency
from app.science.skeleton import Movement
from tests.benchmarks.clips import CLIPS, LONG_WALK, SIX_WALKS, movement, movements
from tests.benchmarks.report import Figure, Report
from tests.science.avatar.captured import RATE_HZ, STATURE_M
from tests.science.avatar.simulated import follow

PARTS = ("tracking", "delay", "floor")
MEAN_LIMIT_DEG, P95_LIMIT_DEG, FRAME_MS = 1.5, 5.0, 1e3 / RATE_HZ
DELAYS_MS = (0.0, 125.0, 350.0)
FLOOR_COST_DEG = 1.0
"""The largest mean error that a floor may add to a walk."""


def measure(parts: frozenset[str], duration_s: float | None = None) -> Report:
    """Measure the named parts; their duration cannot be chosen."""
    report = Report("avatar_tracking")
    if "tracking" in parts:
        for name, clip in movements():
            report.add(*_tracked(name, clip))
    if "delay" in parts:
        report.add(*_delays())
    if "floor" in parts:
        rows = list(_on_floor())
        report.add(*_costs(rows))
        report.beside["rows"] = [asdict(row) for row in rows]
    return report


@cache
def _tuned() -> Configuration:
    return tune(default_configuration(), STATURE_M, wall_s=time.monotonic).configuration


def _tracked(name: str, clip: Movement) -> Iterator[Figure]:
    found = follow_capture(_tuned(), STATURE_M, clip)
    usual = track(default_configuration(), STATURE_M, clip)
    welded = track(replace(_tuned(), hips="welded"), STATURE_M, clip)
    for told, one in (("tuned", found.alone), ("by hand", usual), ("tuned, hips welded", welded)):
        yield from _row(name, told, one.clamped, MEAN_LIMIT_DEG, P95_LIMIT_DEG)
    yield from _row(name, "tuned, to the unclamped targets", found.alone.unclamped)
    shares = {
        "samples clipped by limits": found.alone.clipped_share,
        "frames with a target faster than 40 rad/s": _too_fast(clip),
    }
    for told, share in shares.items():
        yield Figure("tracking", f"{name}: {told}", 100.0 * share, "%")
    yield from _row(name, "tuned, on a floor", found.on_floor.clamped)
    yield from _row(name, "tuned, on a floor, free of touch", found.on_floor.free)
    share = found.on_floor.touching.samples / found.on_floor.clamped.samples
    yield Figure("tracking", f"{name}: on a floor, samples in touch", 100.0 * share, "%")


def _too_fast(clip: Movement) -> float:
    targets = TargetAngles(_tuned().in_force).batch(clip.rotations).angles_rad
    fastest = np.abs(np.diff(targets, axis=0)).max(axis=1) * clip.rate_hz
    return float(np.mean(fastest > MAX_SPEED_RAD_S))


def _row(
    name: str, told: str, found: Spread, mean: float | None = None, p95: float | None = None
) -> Iterator[Figure]:
    if found.samples:
        beside = "" if mean is None else "at most"
        yield Figure("tracking", f"{name}: {told}, mean", found.mean_deg, "deg", beside, mean)
        yield Figure("tracking", f"{name}: {told}, p95", found.p95_deg, "deg", beside, p95)


def _delays() -> Iterator[Figure]:
    for name, file, scene in (
        ("walk and bend", LONG_WALK, EMPTY_SPACE),
        ("reach", CLIPS["reach"][0], EMPTY_SPACE),
        ("reach on a floor", CLIPS["reach"][0], FLOOR_ONLY),
    ):
        clip = movement(file)
        if clip is not None:
            yield from _delayed(name, clip, scene)


def _delayed(name: str, clip: Movement, scene: Scene) -> Iterator[Figure]:
    built = avatar_model(_tuned(), STATURE_M, scene=scene)
    times_s = np.arange(clip.frame_count) / RATE_HZ
    for ordered_ms in DELAYS_MS:
        followed = follow(built, clip, delay_s=ordered_ms / 1e3)
        command = joint_rotations(followed.targets.angles_rad, clip.rotations[:, 0])
        found = achieved_latency(times_s, command, times_s, followed.rotations)
        told = f"{name}, {ordered_ms:g} ms ordered"
        if found.latency_s is None:
            raise AssertionError(f"{told}: no latency was found: {found.reason}")
        late_ms = 1e3 * found.latency_s
        yield Figure("delay", f"{told}: achieved", late_ms, "ms")
        off_ms = abs(late_ms - ordered_ms)
        yield Figure("delay", f"{told}: off by", off_ms, "ms", "at most", FRAME_MS)


@dataclass(frozen=True)
class FloorRow:
    """The errors of one walk against one kind of target, with or without a floor."""

    capture: str
    moves: str
    floor: bool
    against: str
    mean_deg: float
    p95_deg: float
    clipped_share: float


def _on_floor() -> Iterator[FloorRow]:
    for name in SIX_WALKS:
        for travels in (False, True):
            clip = movement(name, travels=travels)
            if clip is None:
                continue
            found = follow_capture(_tuned(), STATURE_M, clip)
            for floor, one in ((False, found.alone), (True, found.on_floor)):
                where = (Path(name).stem, "travels" if travels else "in place", floor)
                for against, spread in (("clamped", one.clamped), ("unclamped", one.unclamped)):
                    errors = (spread.mean_deg, spread.p95_deg, one.clipped_share)
                    yield FloorRow(*where, against, *errors)


def _costs(rows: list[FloorRow]) -> Iterator[Figure]:
    """Return what the floor adds to the mean error of each walk against the clamped targets."""
    for row in rows:
        told = f"{row.capture} {row.moves}, {row.against}"
        where = "on a floor" if row.floor else "nothing around"
        yield Figure("floor", f"{told}, {where}, mean", row.mean_deg, "deg")
        yield Figure("floor", f"{told}, {where}, p95", row.p95_deg, "deg")
    means = {(r.capture, r.moves, r.floor): r.mean_deg for r in rows if r.against == "clamped"}
    for (capture, moves, floor), mean_deg in means.items():
        if floor:
            cost = mean_deg - means[capture, moves, False]
            told = f"{capture} {moves}: the floor adds"
            yield Figure("floor", told, cost, "deg", "at most", FLOOR_COST_DEG)
