"""Measure the size and cost of a minute of a session for every chunk encoding.

A session-minute is two streams, target and actual, of 90 frames a second; a chunk is a second of
one of them. The movement comes from the captures next to the repository (a mean over them), each
with an actual stream that follows its target through a critically damped filter of 4 Hz, 125 ms
late, with its own noise of 0.01 degrees and 0.1 mm; and from a synthetic movement, with all joints
swinging, tracked with a noise of 0.05 degrees and 0.5 mm and followed likewise. Times are CPU times
of one thread, medians over the chunks. Every decoded chunk is compared with its input, bit by bit.

The part `fingers` compares the bytes of a finger part with those of a body's joint, both streams
together: generated hands that make a fist, pinch, oppose the thumb or do all in turn, next to the
synthetic body, tracked with the same noise and followed likewise. Where there is noise, its own
entropy is given as well, below which no lossless encoding can get.
"""

import sys
import time
from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from app.features.record.telemetry.encodings import f32_predicted
from app.features.record.telemetry.encodings.columns import Columns
from app.science.skeleton import FINGER_COUNT, JOINT_COUNT
from tests.benchmarks.codecs import Codec, own_codecs
from tests.benchmarks.report import Figure, Report
from tests.benchmarks.rival_codecs import rival_codecs
from tests.features.record.telemetry.followed_movement import (
    CHUNK_FRAMES,
    OWN_NOISE_DEG,
    RATE_HZ,
    TRACKING_NOISE_DEG,
    Streams,
    captured_movement,
    followed,
    followed_fingers,
    made_fingers,
    made_movement,
)
from tests.support.shared_data import shared_data_folder

PARTS = ("codecs", "noise", "lengths", "fingers")
CAPTURES = shared_data_folder() / "motion" / "cmu_bvh"
MADE_S, REPEATS = 20.0, 3
LIMIT_MB, LIMIT_MS = 3.0, 2.0
IN_USE = f"{f32_predicted.NAME}, zstd {f32_predicted.LEVEL}"
NOISES_DEG = (0.0, 0.01, 0.1, 1.0)
LENGTHS = (9, 30, 90, 180, 450)
HANDS = ("fist", "pinch", "thumb opposition")
Movements = Mapping[str, Sequence[Streams]]


def measure(parts: frozenset[str]) -> Report:
    """Measure the named parts."""
    report = Report("encoding")
    captured = _captured()
    names = ", ".join(captured) or "none found"
    print(f"  captures in {CAPTURES}: {names}", file=sys.stderr)
    movements = {"made up": [_made(TRACKING_NOISE_DEG, OWN_NOISE_DEG)]}
    if captured:
        movements["captures"] = list(captured.values())
    rivals, absent = rival_codecs()
    for library in absent:
        print(f"  {library} is not installed: left out", file=sys.stderr)
    codecs = [*own_codecs(), *rivals]
    if "codecs" in parts:
        for codec in codecs:
            report.add(*_sizes(codec, movements), *_times(codec, movements))
    (ours,) = (codec for codec in codecs if codec.name == IN_USE)
    if "noise" in parts:
        report.add(*_by_noise(ours))
    if "lengths" in parts:
        report.add(*_by_length(ours, movements))
    if "fingers" in parts:
        report.add(*_by_joint(ours))
    return report


def _captured() -> dict[str, Streams]:
    """Return every available capture, keyed by its name."""
    files = sorted(CAPTURES.glob("*.bvh"))
    rng = np.random.default_rng(0)
    return {file.stem: followed(captured_movement(file), rng) for file in files}


def _made(tracking_deg: float, own_deg: float) -> Streams:
    rng = np.random.default_rng(0)
    return followed(made_movement(MADE_S, rng, noise_deg=tracking_deg), rng, noise_deg=own_deg)


def _all(movements: Movements) -> list[Streams]:
    return [streams for several in movements.values() for streams in several]


def _sizes(codec: Codec, movements: Movements) -> Iterator[Figure]:
    for name, several in movements.items():
        megabytes = np.mean([_session_minute_mb(codec, streams) for streams in several])
        yield _size(f"{codec.name}: {name}", float(megabytes))


def _size(name: str, megabytes: float, part: str = "codecs") -> Figure:
    return Figure(part, name, megabytes, "MB/session-min", "limit", LIMIT_MB)


def _session_minute_mb(codec: Codec, streams: Streams, frames: int = CHUNK_FRAMES) -> float:
    """Return the size of 60 s of both streams, in 10^6 bytes."""
    sizes = [len(codec.encode(one)) for pair in streams.chunks(frames) for one in pair]
    seconds = len(sizes) / 2 * frames / RATE_HZ
    return sum(sizes) * 60.0 / seconds / 1e6


def _times(codec: Codec, movements: Movements) -> Iterator[Figure]:
    chunks = [one for streams in _all(movements) for pair in streams.chunks() for one in pair]
    encoding_s, decoding_s = [], []
    for chunk in chunks * REPEATS:
        begun_s = time.thread_time()
        data = codec.encode(chunk)
        encoded_s = time.thread_time()
        back = codec.decode(data, *chunk.values.shape)
        decoding_s.append(time.thread_time() - encoded_s)
        encoding_s.append(encoded_s - begun_s)
        _require_same(codec, chunk, back)
    encode_ms, decode_ms = (1000 * float(np.median(one)) for one in (encoding_s, decoding_s))
    yield Figure("codecs", f"{codec.name}: encode", encode_ms, "ms/chunk", "limit", LIMIT_MS)
    yield Figure("codecs", f"{codec.name}: decode", decode_ms, "ms/chunk")
    yield Figure("codecs", f"{codec.name}: throughput", 1000 / encode_ms, "chunks/s/core")


def _require_same(codec: Codec, chunk: Columns, back: Columns) -> None:
    pairs = (
        (chunk.times_s, back.times_s),
        (chunk.flags, back.flags),
        (chunk.values, back.values),
    )
    if any(before.tobytes() != after.tobytes() for before, after in pairs):
        raise AssertionError(f"{codec.name} does not give back what it was given")


def _by_noise(ours: Codec) -> Iterator[Figure]:
    """Measure the synthetic movement with equal white noise on both streams, at several levels."""
    for noise_deg in NOISES_DEG:
        megabytes = _session_minute_mb(ours, _made(noise_deg, noise_deg))
        yield _size(f"noise of {noise_deg:g} degrees", megabytes, "noise")
    streams = _made(TRACKING_NOISE_DEG, OWN_NOISE_DEG)
    single = Streams(streams.times_s, _in_single(streams.target), _in_single(streams.actual))
    megabytes = _session_minute_mb(ours, single)
    yield _size("made up, normalised again in single precision", megabytes, "noise")


def _in_single(values: NDArray[np.float32]) -> NDArray[np.float32]:
    """Return values (n, 91) with quaternions computed in float32, as engines do."""
    turns = values[:, 3:].reshape(len(values), 22, 4) * np.float32(1.1)
    turns /= np.sqrt(np.einsum("nji,nji->nj", turns, turns))[..., np.newaxis]
    return np.concatenate((values[:, :3], turns.reshape(len(values), -1)), axis=1)


def _by_length(ours: Codec, movements: Movements) -> Iterator[Figure]:
    """Measure whether longer chunks, or both streams in one, would be smaller."""
    long = [one for one in _all(movements) if len(one.times_s) >= max(LENGTHS)]
    for frames in LENGTHS:
        sizes = [_session_minute_mb(ours, one, frames) for one in long]
        yield _size(f"chunks of {frames} frames", float(np.mean(sizes)), "lengths")
    sizes = [_together_mb(ours, streams) for streams in long]
    yield _size("both streams in a chunk of 90 frames", float(np.mean(sizes)), "lengths")


def _together_mb(ours: Codec, streams: Streams) -> float:
    """Return the size of a session-minute with both streams in one chunk, with shared times."""
    sizes = []
    for target, actual in streams.chunks():
        both = np.concatenate((target.values, actual.values[:, 3:]), axis=1)
        # The second root, which has no place in a chunk: alone, with times at no cost.
        root = Columns(np.zeros(len(both)), actual.flags, actual.values[:, :3])
        sizes.append(sum(len(ours.encode(one)) for one in (_with_values(target, both), root)))
    return sum(sizes) * 60.0 / (len(sizes) * CHUNK_FRAMES / RATE_HZ) / 1e6


def _by_joint(ours: Codec) -> Iterator[Figure]:
    """Measure the bytes a frame of joints and of finger parts, without and with tracking noise."""
    for noise_deg in (0.0, TRACKING_NOISE_DEG):
        own_deg = min(noise_deg, OWN_NOISE_DEG)
        body = _bytes_a_joint(ours, _made(noise_deg, own_deg), JOINT_COUNT)
        tracked = f"tracked with {noise_deg:g} degrees of noise"
        yield Figure("fingers", f"body, {tracked}", body, "B/joint/frame")
        for gesture in (*HANDS, None):
            rng = np.random.default_rng(0)
            hands = made_fingers(MADE_S, rng, noise_deg=noise_deg, gesture=gesture)
            streams = followed_fingers(hands, rng, own_deg)
            name = f"{gesture or 'gestures in turn'} (generated), {tracked}"
            found = _bytes_a_joint(ours, streams, FINGER_COUNT)
            yield Figure("fingers", name, found, "B/joint/frame", "limit", body)
            if noise_deg > 0.0:
                least = (
                    _noise_bytes(streams.target, noise_deg) + _noise_bytes(streams.actual, own_deg)
                ) / 2.0
                yield Figure("fingers", f"{name}: the noise alone", least, "B/joint/frame")


def _bytes_a_joint(ours: Codec, streams: Streams, joints: int) -> float:
    pairs = list(streams.chunks())
    size = sum(len(ours.encode(one)) for pair in pairs for one in pair)
    return size / (len(pairs) * 2 * CHUNK_FRAMES * joints)


def _noise_bytes(rotations: NDArray[np.float32], noise_deg: float) -> float:
    """Return the entropy of the noise of `noisy` in rotations (n, 4 J), in bytes for each of them.

    No lossless encoding takes less on average, not even one that knows the movement: the three
    smaller components of a unit quaternion have independent normal noise, rounded to floats, and
    the largest one follows from them.
    """
    quaternions = np.abs(rotations.reshape(-1, 4))
    quaternions.sort(axis=1)
    steps = np.spacing(quaternions[:, :3]).astype(np.float64)
    deviation = np.radians(noise_deg) / 2.0
    each_bits = np.log2(deviation * np.sqrt(2.0 * np.pi * np.e)) - np.log2(steps)
    # The noise is perpendicular to the quaternion; this is the part of it across the largest one.
    seen_bits = np.log2(quaternions[:, 3].astype(np.float64))
    return float(np.mean(each_bits.sum(axis=1) + seen_bits)) / 8.0


def _with_values(columns: Columns, values: NDArray[np.float32]) -> Columns:
    return Columns(columns.times_s, columns.flags, values)
