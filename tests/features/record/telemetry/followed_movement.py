"""Streams of a motor-driven body: the actual stream follows the target stream, filtered.

Each number of the actual stream goes through a critically damped second-order filter, as a joint
under proportional-derivative control does, after the study's delay; then the quaternions are
normalised and get their own noise. So no frame of it is a copy of a target frame.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from app.features.record.telemetry.encodings.columns import Columns
from app.science.avatar.targets import finger_rotations
from app.science.rotations import normalise
from app.science.simulation import SimulatedFingers, gesture_angles
from app.science.skeleton import Movement, build_skeleton, continuous, resample
from app.simulated_people.body import FRAME_RATE_HZ
from app.simulated_people.body import captured_movement as on_skeleton

RATE_HZ = FRAME_RATE_HZ
LATENCY_S = 0.125
NATURAL_HZ = 4.0
OWN_NOISE_DEG, TRACKING_NOISE_DEG = 0.01, 0.05
NOISE_MM_PER_DEG = 10.0
TIME_JITTER_S = 20e-6
CHUNK_FRAMES = 90
STATURE_M = 1.72


@dataclass(frozen=True)
class Streams:
    """Both streams at 90 Hz: `times_s` (n,) and the values (n, 91) of each."""

    times_s: NDArray[np.float64]
    target: NDArray[np.float32]
    actual: NDArray[np.float32]

    def chunks(self, frames: int = CHUNK_FRAMES) -> Iterator[tuple[Columns, Columns]]:
        """Yield whole chunks of target and actual stream, as they are folded."""
        for begin in range(0, len(self.times_s) - frames + 1, frames):
            at = slice(begin, begin + frames)
            flags = np.ones(frames, np.uint8)
            yield (
                Columns(self.times_s[at], flags, self.target[at]),
                Columns(self.times_s[at], flags, self.actual[at]),
            )


def followed(
    movement: Movement, rng: np.random.Generator, *, noise_deg: float = OWN_NOISE_DEG
) -> Streams:
    """Return both streams of a movement at 90 Hz, the actual one with `noise_deg` of noise."""
    count = movement.frame_count
    turns = continuous(movement.rotations).reshape(count, -1)
    return _followed(np.concatenate((movement.root_positions_m, turns), axis=1), rng, noise_deg)


def followed_fingers(
    rotations: NDArray[np.float64], rng: np.random.Generator, noise_deg: float
) -> Streams:
    """Return both streams of fingers (n, 30, 4) at 90 Hz, the actual one with noise of its own."""
    return _followed(continuous(rotations).reshape(len(rotations), -1), rng, noise_deg)


def _followed(target: NDArray[np.float64], rng: np.random.Generator, noise_deg: float) -> Streams:
    count = len(target)
    times_s = 1000.0 + np.arange(count) / RATE_HZ + rng.normal(0.0, TIME_JITTER_S, count)
    late = np.maximum(np.arange(count) - round(LATENCY_S * RATE_HZ), 0)
    actual = noisy(_filtered(target[late]), rng, noise_deg)
    return Streams(times_s, target.astype(np.float32), actual.astype(np.float32))


def made_movement(
    duration_s: float, rng: np.random.Generator, *, noise_deg: float = TRACKING_NOISE_DEG
) -> Movement:
    """Return a movement of all 22 joints, swinging at 0.1 to 2 Hz and tracked with noise."""
    count = round(duration_s * RATE_HZ)
    time_s = np.arange(count)[:, np.newaxis, np.newaxis] / RATE_HZ
    values = np.zeros((count, 91))
    values[:, 1] = 1.0
    for _ in range(4):
        hertz, phase, size = (
            rng.uniform(low, high, (91, 1)) for low, high in ((0.1, 2.0), (0.0, 6.3), (0.0, 0.1))
        )
        values += (size * np.sin(2.0 * np.pi * hertz * time_s + phase))[..., 0]
    values[:, 3::4] += 1.0
    values = noisy(values, rng, noise_deg)
    return Movement(RATE_HZ, values[:, :3], values[:, 3:].reshape(count, 22, 4))


def made_fingers(
    duration_s: float,
    rng: np.random.Generator,
    *,
    noise_deg: float = TRACKING_NOISE_DEG,
    gesture: str | None = None,
) -> NDArray[np.float64]:
    """Return generated fingers (n, 30, 4), tracked with noise in every direction.

    Both hands close into a gesture and relax once a second, or make all gestures in turn.
    """
    times_s = np.arange(round(duration_s * RATE_HZ)) / RATE_HZ
    if gesture is None:
        hands = SimulatedFingers(rng)
        rotations = np.stack([hands.pose(time_s) for time_s in times_s])
    else:
        share = (0.5 - 0.5 * np.cos(2.0 * np.pi * times_s))[:, np.newaxis]
        closed, open_ = (
            gesture_angles(name, "Left") + gesture_angles(name, "Right")
            for name in (gesture, "relaxed")
        )
        rotations = finger_rotations(open_ + share * (closed - open_))
    return noisy(rotations.reshape(len(times_s), -1), rng, noise_deg).reshape(-1, 30, 4)


def captured_movement(capture: Path) -> Movement:
    """Return a capture on our skeleton at 90 Hz, as the rehearsal uses it but not looped."""
    return resample(on_skeleton(capture, build_skeleton(STATURE_M)), RATE_HZ)


def noisy(
    values: NDArray[np.float64], rng: np.random.Generator, noise_deg: float
) -> NDArray[np.float64]:
    """Return values (n, 91) with white noise: `noise_deg` about joint axes, and the root's.

    Values of fingers (n, 120) have no root.
    """
    count, before = len(values), values.shape[1] % 4
    move_m = NOISE_MM_PER_DEG * noise_deg / 1000.0
    root = values[:, :before] + rng.normal(0.0, move_m, (count, before))
    turns = normalise(values[:, before:].reshape(count, -1, 4))
    # A turn by a small angle moves a unit quaternion by half that angle, perpendicular to itself.
    turned = normalise(turns + rng.normal(0.0, np.radians(noise_deg) / 2.0, turns.shape))
    return np.concatenate((root, turned.reshape(count, -1)), axis=1)


def _filtered(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return values (n, 91) after two one-pole filters: critical damping, from rest."""
    keep = np.exp(-2.0 * np.pi * NATURAL_HZ / RATE_HZ)
    for _ in range(2):
        change = lfilter([1.0 - keep], [1.0, -keep], values - values[0], axis=0)
        values = values[0] + np.asarray(change)
    return values
