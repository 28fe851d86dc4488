"""Synthetic recordings of two bodies whose latency is known."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from app.science import rotations as rot
from app.science.delay import delayed_pose
from app.science.latency.achieved_latency import StreamPair
from app.science.rotations import FloatArray
from app.science.skeleton import build_skeleton
from app.science.skeleton.movement import loop, resample
from app.simulated_people.body import captured_movement

RATE_HZ = 90.0
HISTORY_S = 2.0
Movement = Callable[[FloatArray], FloatArray]
"""A function that returns local rotations (k, 22, 4) at times (k,) in seconds."""


@dataclass(frozen=True)
class Flaws:
    """Flaws of a real recording, applied to each stream independently.

    Standard deviations: `noise_deg` of each component of each rotation, `jitter_s` of a frame's
    capture time, `stamp_s` of its timestamp relative to that. `dropped` is a share of the frames.
    """

    noise_deg: float = 0.0
    jitter_s: float = 0.0
    stamp_s: float = 0.0
    dropped: float = 0.0


def made_movement(
    rng: np.random.Generator, *, highest_hz: float = 2.5, joints: int = 22, size_deg: float = 15.0
) -> Movement:
    """Return a movement of every joint about a random pose by eight sines up to `highest_hz`."""
    shape = (joints, 3, 8)
    frequency_hz = rng.uniform(0.1, highest_hz, shape)
    phase = rng.uniform(0.0, 2.0 * np.pi, shape)
    size = np.radians(size_deg) * rng.normal(size=shape) / np.sqrt(shape[-1]) / (1.0 + frequency_hz)
    pose = rot.from_rotation_vector(0.7 * rng.normal(size=(joints, 3)))

    def swing(times_s: FloatArray) -> FloatArray:
        angle = 2.0 * np.pi * frequency_hz[..., np.newaxis] * times_s + phase[..., np.newaxis]
        vectors: FloatArray = np.einsum("jcn,jcnk->kjc", size, np.sin(angle))
        return vectors

    def at(times_s: FloatArray) -> FloatArray:
        pieces = np.array_split(times_s, max(1, len(times_s) // 1000))
        vectors = np.concatenate([swing(piece) for piece in pieces])
        return rot.multiply(pose, rot.from_rotation_vector(vectors))

    return at


def record(
    movement: Movement,
    latency_s: float,
    rng: np.random.Generator,
    flaws: Flaws = Flaws(),
    *,
    duration_s: float = 60.0,
    rate_hz: float = RATE_HZ,
) -> StreamPair:
    """Return the streams of one movement, the actual one `latency_s` later."""
    target_times_s, target = _stream(movement, 0.0, rng, flaws, -HISTORY_S, duration_s, rate_hz)
    actual_times_s, actual = _stream(movement, latency_s, rng, flaws, 0.0, duration_s, rate_hz)
    active = np.ones(len(actual_times_s), dtype=np.bool_)
    return StreamPair(target_times_s, target, actual_times_s, actual, active)


def delayed_copy(times_s: FloatArray, rotations: FloatArray, latency_s: float) -> StreamPair:
    """Return the target and the avatar that the headset's delay buffer makes of it, as stored."""
    stored = rotations.astype(np.float32).astype(np.float64)
    avatar = delayed_pose(times_s, rotations, times_s, latency_s)
    since = times_s >= times_s[0] + HISTORY_S
    return StreamPair(
        times_s,
        stored,
        times_s[since],
        avatar[since].astype(np.float32).astype(np.float64),
        np.ones(int(since.sum()), dtype=np.bool_),
    )


def looped_capture(file: Path, duration_s: float) -> tuple[FloatArray, FloatArray]:
    """Return times and rotations of a capture that repeats, at the headset's rate."""
    movement = loop(resample(captured_movement(file, build_skeleton(1.75)), RATE_HZ))
    frames = np.arange(round(duration_s * RATE_HZ))
    return frames / RATE_HZ, movement.rotations[frames % movement.frame_count]


def _stream(
    movement: Movement,
    latency_s: float,
    rng: np.random.Generator,
    flaws: Flaws,
    begin_s: float,
    end_s: float,
    rate_hz: float,
) -> tuple[FloatArray, FloatArray]:
    times_s = np.arange(begin_s, end_s, 1.0 / rate_hz) + rng.uniform(0.0, 1.0 / rate_hz)
    times_s = np.sort(times_s + flaws.jitter_s * rng.normal(size=len(times_s)))
    times_s = times_s[rng.random(len(times_s)) >= flaws.dropped]
    noise = np.radians(flaws.noise_deg) * rng.normal(size=(len(times_s), 22, 3))
    rotations = rot.multiply(movement(times_s - latency_s), rot.from_rotation_vector(noise))
    return times_s + flaws.stamp_s * rng.normal(size=len(times_s)), rotations
