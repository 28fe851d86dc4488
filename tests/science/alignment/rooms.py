"""A person in a room with two tracking systems: what each says, and what is true."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from app.adapters.captures import read_capture_file
from app.science.alignment import Alignment, PoseStream
from app.science.rig import BodyMotion
from app.science.rotations import (
    FloatArray,
    conjugate,
    from_euler,
    from_rotation_vector,
    identity,
    multiply,
    normalise,
    rotate,
)

HEADSET_HZ, TRACKER_HZ = 90.0, 100.0
FOOT_FROM_HEAD_M = (0.2, -1.58, 0.1)


@dataclass(frozen=True, eq=False)
class Noise:
    """Standard deviations per axis, in metres and radians, and the share of gross errors."""

    tracker_m: float = 0.001
    tracker_rad: float = float(np.radians(0.2))
    headset_m: float = 0.0005
    headset_rad: float = float(np.radians(0.05))
    gross: float = 0.0


OPTICAL = Noise()
INSIDE_OUT = Noise(tracker_m=0.005, tracker_rad=float(np.radians(0.7)))


@dataclass(frozen=True, eq=False)
class Room:
    """How a tracking system lies in the headset's world, and how its tracker sits on the head.

    The truth in the sense of `Alignment`; `drift_m_s` counts from time 0.
    """

    rotation: FloatArray
    position_m: FloatArray
    mount_rotation: FloatArray
    mount_m: FloatArray
    delay_s: float = 0.03
    drift_m_s: tuple[float, float, float] = (0.0, 0.0, 0.0)


def some_room(rng: np.random.Generator) -> Room:
    """Return a room with any heading, a floor that is not quite level, and any mount."""
    heading = from_rotation_vector(np.array((0.0, rng.uniform(-3.0, 3.0), 0.0)))
    level = from_rotation_vector(rng.normal(0.0, 0.01, 3))
    return Room(
        rotation=multiply(heading, level),
        position_m=rng.uniform(-1.0, 1.0, 3),
        mount_rotation=from_rotation_vector(rng.uniform(-1.0, 1.0, 3)),
        mount_m=rng.uniform(-0.12, 0.12, 3),
    )


def looking_around(seconds: float, rate_hz: float = 400.0) -> PoseStream:
    """Return a head that looks to all sides while its wearer stands and sways."""
    t = np.arange(0.0, seconds, 1.0 / rate_hz)
    turn = 0.7 * np.sin(1.3 * t) + 0.2 * np.sin(3.1 * t)
    nod, tilt = 0.4 * np.sin(1.9 * t + 1.0), 0.25 * np.sin(1.1 * t + 2.0)
    sway = (0.15 * np.sin(0.9 * t), 1.6 + 0.05 * np.sin(1.7 * t), 0.12 * np.cos(0.7 * t))
    turned = from_euler("YXZ", np.stack((turn, nod, tilt), axis=-1))
    return PoseStream.of(t, np.stack(sway, axis=-1), turned)


def captured_head(path: Path, times: int) -> PoseStream:
    """Return the head of a capture that is played forwards and backwards so many times."""
    motion = read_capture_file(path).motion
    assert isinstance(motion, BodyMotion)
    head = motion.names.index("head")
    once = np.arange(motion.frame_count)
    there = [once, once[-2::-1]]
    order = np.concatenate([once, *(there[n % 2][1:] for n in range(1, times))])
    t = np.arange(len(order)) / motion.rate_hz
    return PoseStream.of(t, motion.positions_m[order, head], motion.rotations[order, head])


def recorded(
    head: PoseStream, room: Room, noise: Noise, rng: np.random.Generator
) -> tuple[PoseStream, PoseStream]:
    """Return what headset and tracker say of a head, each at its own rate."""
    end_s = float(head.times_s[-1]) - 0.1
    at_s = np.arange(0.0, end_s, 1.0 / HEADSET_HZ)
    headset_m, headset_q, _ = head.at(at_s)
    from_s = np.arange(0.0, end_s, 1.0 / TRACKER_HZ)
    tracker = seen_by(room, PoseStream.of(from_s, *head.at(from_s)[:2]))
    headset = _noisy(at_s, headset_m, headset_q, noise.headset_m, noise.headset_rad, rng)
    tracker = _noisy(
        tracker.times_s,
        tracker.positions_m,
        tracker.rotations,
        noise.tracker_m,
        noise.tracker_rad,
        rng,
    )
    wrong = rng.random(len(from_s)) < noise.gross
    also = rng.random(len(from_s)) < 0.5  # the other half has a wrong position only
    anywhere = rng.normal(0.0, 0.3, (len(from_s), 3))
    anyhow = normalise(rng.normal(size=(len(from_s), 4)))
    return headset, PoseStream.of(
        tracker.times_s,
        tracker.positions_m + wrong[:, np.newaxis] * anywhere,
        np.where((wrong & also)[:, np.newaxis], anyhow, tracker.rotations),
    )


def seen_by(room: Room, head: PoseStream) -> PoseStream:
    """Return the tracker on the head as its system sees it, without noise."""
    world_from_headset = conjugate(room.rotation)
    turned = multiply(multiply(world_from_headset, head.rotations), conjugate(room.mount_rotation))
    where = in_tracking_world(room, head.times_s, head.positions_m)
    return PoseStream.of(head.times_s + room.delay_s, where - rotate(turned, room.mount_m), turned)


def in_tracking_world(room: Room, times_s: FloatArray, points_m: FloatArray) -> FloatArray:
    """Return points of the headset's world (N, 3) as the tracking system sees them."""
    moved = times_s[:, np.newaxis] * np.asarray(room.drift_m_s)
    return rotate(conjugate(room.rotation), points_m - moved - room.position_m)


def foot_errors(found: Alignment, room: Room, head: PoseStream) -> FloatArray:
    """Return how far a foot below the head is from where it should be, in metres (N,)."""
    feet = head.positions_m + np.array(FOOT_FROM_HEAD_M)
    seen = in_tracking_world(room, head.times_s, feet)
    at_s = head.times_s + found.mount.delay_s
    _, brought, _ = found.to_headset(at_s, seen, identity(len(seen)))
    errors_m: FloatArray = np.linalg.norm(brought - feet, axis=1)
    return errors_m


def moved_world(stream: PoseStream, turn: FloatArray, shift_m: FloatArray) -> PoseStream:
    """Return the same poses in a world that is turned and shifted."""
    return replace(
        stream,
        positions_m=rotate(turn, stream.positions_m) + shift_m,
        rotations=multiply(turn, stream.rotations),
    )


def joined(before: PoseStream, after: PoseStream, at_s: float) -> PoseStream:
    """Return a stream that is `before` until a time and `after` from then on."""
    parts = (before.between(-np.inf, np.nextafter(at_s, -np.inf)), after.between(at_s, np.inf))
    return PoseStream.of(
        *(
            np.concatenate([getattr(part, name) for part in parts])
            for name in ("times_s", "positions_m", "rotations", "weights")
        )
    )


def _noisy(
    times_s: FloatArray,
    positions_m: FloatArray,
    rotations: FloatArray,
    spread_m: float,
    spread_rad: float,
    rng: np.random.Generator,
) -> PoseStream:
    shifts, turns = (rng.normal(0.0, one, positions_m.shape) for one in (spread_m, spread_rad))
    turned = multiply(rotations, from_rotation_vector(turns))
    return PoseStream.of(times_s, positions_m + shifts, turned)
