"""Encode what a source of trackers sent as columns, without loss of a bit, and decode it.

A chunk has one row per pose of a packet. Its columns, little-endian, one after the other, each of
the floats split into the first bytes of all rows, then the second ones and so on (similar bytes
side by side compress better), all together compressed by zlib (RFC 1950):

    u16      tracker, as an index into the chunk's names
    u8       flags: bit 0 the source tracks it, bit 1 has a position, bit 2 has a rotation
    f64      source_s: time by the source's own clock, NaN if it sends none
    f64      arrival_s: when the packet arrived, by the server's monotonic clock
    f64      mapped_s: the source's time on the server's clock, or the arrival
    f64      uncertainty_s of mapped_s, NaN if it is not known
    f64[3]   position x, y, z (m, the source's world), NaN if there is none
    f64[4]   rotation w, x, y, z (world_from_tracker, as it was sent), NaN if there is none
"""

import zlib
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from app.features.movement.live import Sample

ENCODING = "tracker_columns_1"
_TRACKED, _POSITION, _ROTATION = 1, 2, 4
_FLOATS = 11
_ROW_BYTES = 3 + 8 * _FLOATS
_NOWHERE = (float("nan"),) * 3
_NO_ROTATION = (float("nan"),) * 4


@dataclass(frozen=True, eq=False)
class TrackerSamples:
    """The poses of a chunk, in the order of their arrival; see the module for the columns.

    Attributes:
        trackers: names, to which `tracker` refers.
        tracker: (N,) index of each pose's tracker.
        tracked: (N,) whether the source tracks it.
        source_s, arrival_s, mapped_s, uncertainty_s: (N,) seconds.
        positions_m: (N, 3) in the source's world, NaN where a pose has none.
        rotations: (N, 4) w, x, y, z, NaN where a pose has none.
    """

    trackers: tuple[str, ...]
    tracker: NDArray[np.uint16]
    tracked: NDArray[np.bool_]
    source_s: NDArray[np.float64]
    arrival_s: NDArray[np.float64]
    mapped_s: NDArray[np.float64]
    uncertainty_s: NDArray[np.float64]
    positions_m: NDArray[np.float64]
    rotations: NDArray[np.float64]


def encode_samples(samples: Sequence[Sample]) -> tuple[list[str], int, bytes]:
    """Return the trackers' names, the number of poses, and their columns, of samples with poses."""
    index: dict[str, int] = {}
    trackers: list[int] = []
    flags: list[int] = []
    floats: list[tuple[float, ...]] = []
    for sample in samples:
        nan = float("nan")
        times = (
            nan if sample.source_s is None else sample.source_s,
            sample.arrival_s,
            sample.mapped_s,
            nan if sample.uncertainty_s is None else sample.uncertainty_s,
        )
        for pose in sample.poses:
            position, rotation = pose.position_m, pose.rotation
            trackers.append(index.setdefault(pose.tracker, len(index)))
            flags.append(
                (_TRACKED if pose.tracked else 0)
                | (_POSITION if position is not None else 0)
                | (_ROTATION if rotation is not None else 0)
            )
            floats.append((*times, *(position or _NOWHERE), *(rotation or _NO_ROTATION)))
    columns = np.array(floats, dtype="<f8").reshape(-1, _FLOATS)
    planes = columns.view(np.uint8).reshape(len(columns), -1).T.tobytes()
    head = np.array(trackers, dtype="<u2").tobytes() + bytes(flags)
    return list(index), len(flags), zlib.compress(head + planes, 1)


def decode_samples(trackers: Sequence[str], count: int, data: bytes) -> TrackerSamples:
    """Return the poses of a chunk; raises ValueError if its bytes are damaged."""
    try:
        raw = zlib.decompress(data)
    except zlib.error as error:
        raise ValueError(f"The tracker samples are damaged: {error}.") from error
    if len(raw) != count * _ROW_BYTES:
        raise ValueError(
            f"The tracker samples have {len(raw)} bytes; {count} poses have {count * _ROW_BYTES}."
        )
    tracker = np.frombuffer(raw, "<u2", count)
    flags = np.frombuffer(raw, np.uint8, count, 2 * count)
    planes = np.frombuffer(raw, np.uint8, offset=3 * count).reshape(8 * _FLOATS, count)
    floats = np.ascontiguousarray(planes.T).view("<f8").reshape(count, _FLOATS)
    if count > 0 and int(tracker.max()) >= len(trackers):
        raise ValueError(
            f"The tracker samples name tracker {int(tracker.max())} of {len(trackers)}."
        )
    return TrackerSamples(
        trackers=tuple(trackers),
        tracker=tracker,
        tracked=(flags & _TRACKED).astype(np.bool_),
        source_s=floats[:, 0],
        arrival_s=floats[:, 1],
        mapped_s=floats[:, 2],
        uncertainty_s=floats[:, 3],
        positions_m=floats[:, 4:7],
        rotations=floats[:, 7:],
    )
