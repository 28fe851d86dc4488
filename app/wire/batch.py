"""The binary telemetry batch: a 64-byte header and little-endian arrays, read without copying.

    offset  type     field
    0       4 bytes  magic "RMB1"
    4       u16      header length, 64
    6       u8       stream: 1 target, 2 actual, 3 target_fingers, 4 actual_fingers
    7       u8       reserved, 0
    8       u32      epoch: one run of the client; a restart takes a new one
    12      u32      phase_id the frames belong to, 0 outside phases
    16      u64      seq of the first frame; seqs are consecutive within an epoch
    24      u16      frame count n, 1..1024
    26      u16      values per frame w: 91 for a body, 120 for fingers
    28      u32      CRC-32 of everything after the header
    32      f64      active time of the phase at the last frame, s
    40      f64      client monotonic time when the batch was closed, s
    48      16 bytes reserved, 0
    64      f64[n]   client monotonic time of each frame, s
    ...     u8[n]    frame flags (bit 0: the phase's clock ran), zero-padded to a multiple of 8
    ...     f32[n,w] body: root position x, y, z (m, world), then the local rotations w, x, y, z of
                     22 joints
                     fingers: 30 parts' local rotations w, x, y, z (`app.science.skeleton.fingers`)

The frames of all streams that show the same moment have the same seq. The two streams of fingers
are optional. A hand that is not tracked has NaN in all of its 60 values.
"""

import struct
import zlib
from collections.abc import Mapping
from enum import StrEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

MAGIC = b"RMB1"
HEADER = struct.Struct("<4sHBBIIQHHIdd16x")
HEADER_BYTES = HEADER.size
BODY_JOINTS = 22
VALUES_PER_FRAME = 3 + 4 * BODY_JOINTS
FINGER_PARTS = 30
FINGER_VALUES_PER_FRAME = 4 * FINGER_PARTS
MAX_FRAMES = 1024
MAX_TIME_S = 1e9
ACTIVE = 1
"""Frame flag: the phase's clock ran when this frame was shown."""


class StreamName(StrEnum):
    """The stream of a batch.

    `target` is the tracked pose, `actual` the pose of the remote avatar; those of their fingers are
    streams of their own, which many sessions do not have.
    """

    TARGET = "target"
    ACTUAL = "actual"
    TARGET_FINGERS = "target_fingers"
    ACTUAL_FINGERS = "actual_fingers"

    @property
    def values_per_frame(self) -> int:
        """Return the number of values of a frame."""
        return FINGER_VALUES_PER_FRAME if self in FINGER_STREAMS else VALUES_PER_FRAME


BODY_STREAMS = (StreamName.TARGET, StreamName.ACTUAL)
FINGER_STREAMS = (StreamName.TARGET_FINGERS, StreamName.ACTUAL_FINGERS)
PARTICIPANT_STREAMS = (StreamName.TARGET, StreamName.TARGET_FINGERS)
"""The participant's own movement, which every reader may know; the avatar's tells the condition."""
STREAM_OF_CODE = {
    1: StreamName.TARGET,
    2: StreamName.ACTUAL,
    3: StreamName.TARGET_FINGERS,
    4: StreamName.ACTUAL_FINGERS,
}
CODE_OF_STREAM = {name: code for code, name in STREAM_OF_CODE.items()}


class MalformedBatchError(ValueError):
    """The bytes are not a valid batch; none of them were stored."""


class BatchHeader(NamedTuple):
    """The first 64 bytes of a batch, checked against the length of the message."""

    stream: StreamName
    epoch: int
    phase_id: int
    seq_first: int
    frame_count: int
    values_per_frame: int
    crc32: int
    active_s: float
    closed_at_s: float

    @property
    def seq_end(self) -> int:
        """The seq after the last one of the batch."""
        return self.seq_first + self.frame_count


class Batch(NamedTuple):
    """A decoded batch: `times_s` (n,), `flags` (n,), `values` (n, w) are views on the message."""

    header: BatchHeader
    times_s: NDArray[np.float64]
    flags: NDArray[np.uint8]
    values: NDArray[np.float32]


def body_bytes(frame_count: int, values_per_frame: int) -> int:
    """Return the number of bytes that follow the header in a batch of this size."""
    return 8 * frame_count + _padded(frame_count) + 4 * frame_count * values_per_frame


def decode_header(message: bytes) -> BatchHeader:
    """Parse and check the header; MalformedBatchError names the field, its value and the rule."""
    if len(message) < HEADER_BYTES:
        raise MalformedBatchError(
            f"message of {len(message)} bytes; a batch has {HEADER_BYTES} and more"
        )
    magic, length, code, _, epoch, phase_id, seq, n, w, crc, active, closed = HEADER.unpack_from(
        message
    )
    if magic != MAGIC or length != HEADER_BYTES:
        raise MalformedBatchError(
            f"magic {magic!r}, header length {length}; expected {MAGIC!r}, 64"
        )
    stream = STREAM_OF_CODE.get(code)
    if stream is None:
        named = ", ".join(f"{valid} ({name})" for valid, name in STREAM_OF_CODE.items())
        raise MalformedBatchError(f"stream code {code}; valid are {named}")
    if not 1 <= n <= MAX_FRAMES:
        raise MalformedBatchError(f"frame count {n}; valid are 1 to {MAX_FRAMES}")
    if w != stream.values_per_frame:
        raise MalformedBatchError(
            f"{w} values per frame of stream {stream}; expected {stream.values_per_frame}"
        )
    _require_usable(seq, phase_id, {"active_s": active, "closed_at_s": closed})
    expected = HEADER_BYTES + body_bytes(n, w)
    if len(message) != expected:
        raise MalformedBatchError(f"message of {len(message)} bytes; {n} frames need {expected}")
    return BatchHeader(stream, epoch, phase_id, seq, n, w, crc, float(active), float(closed))


def _require_usable(seq: int, phase_id: int, times_s: Mapping[str, float]) -> None:
    """Raise MalformedBatchError if the header's seq, phase or times are invalid.

    The samples themselves may have any value.
    """
    if seq >= 2**62:
        raise MalformedBatchError(f"seq {seq} is out of range; seqs start at 0 in each epoch")
    if phase_id >= 2**31:
        raise MalformedBatchError(f"phase_id {phase_id} is out of range; phases count from 1")
    for name, time_s in times_s.items():
        if not 0.0 <= time_s <= MAX_TIME_S:
            raise MalformedBatchError(f"{name} {time_s}; expected 0 to {MAX_TIME_S:g} s")


def decode_batch(message: bytes) -> Batch:
    """Decode `message`; raise MalformedBatchError if it is invalid or its checksum is wrong."""
    header = decode_header(message)
    crc = zlib.crc32(memoryview(message)[HEADER_BYTES:])
    if crc != header.crc32:
        raise MalformedBatchError(f"checksum {crc:#010x}; the header says {header.crc32:#010x}")
    n, w = header.frame_count, header.values_per_frame
    flags_at = HEADER_BYTES + 8 * n
    values_at = flags_at + _padded(n)
    return Batch(
        header,
        np.frombuffer(message, "<f8", n, HEADER_BYTES),
        np.frombuffer(message, "u1", n, flags_at),
        np.frombuffer(message, "<f4", n * w, values_at).reshape(n, w),
    )


def encode_batch(
    stream: StreamName,
    *,
    epoch: int,
    phase_id: int,
    seq_first: int,
    times_s: NDArray[np.float64],
    flags: NDArray[np.uint8],
    values: NDArray[np.float32],
    active_s: float,
    closed_at_s: float,
) -> bytes:
    """Encode frames: `times_s` (n,), `flags` (n,), `values` (n, 91), or (n, 120) for fingers."""
    n, w = values.shape
    expected = stream.values_per_frame
    if w != expected or times_s.shape != (n,) or flags.shape != (n,):
        raise MalformedBatchError(
            f"shapes {times_s.shape}, {flags.shape}, {values.shape}; expected (n,), (n,),"
            f" (n, {expected})"
        )
    body = b"".join(
        (
            np.ascontiguousarray(times_s, "<f8").tobytes(),
            np.ascontiguousarray(flags, "u1").tobytes().ljust(_padded(n), b"\0"),
            np.ascontiguousarray(values, "<f4").tobytes(),
        )
    )
    return (
        HEADER.pack(
            MAGIC,
            HEADER_BYTES,
            CODE_OF_STREAM[stream],
            0,
            epoch,
            phase_id,
            seq_first,
            n,
            w,
            zlib.crc32(body),
            active_s,
            closed_at_s,
        )
        + body
    )


def _padded(count: int) -> int:
    return -(-count // 8) * 8
