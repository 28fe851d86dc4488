"""Tests that binary batches keep every bit of their frames, and invalid ones are rejected."""

import struct
import zlib

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from app.wire import (
    BODY_STREAMS,
    HEADER_BYTES,
    VALUES_PER_FRAME,
    MalformedBatchError,
    StreamName,
    decode_batch,
    encode_batch,
)
from app.wire.batch import HEADER
from tests.wire.samples import bits, every_odd_float, message, standing

FIELDS = ("magic", "length", "stream", "reserved", "epoch", "phase_id", "seq", "n", "w", "crc")


def changed(field: str, value: object) -> bytes:
    """Return a valid batch of three frames with one header field replaced."""
    good = message(standing(3))
    parts = dict(zip((*FIELDS, "active_s", "closed_at_s"), HEADER.unpack_from(good), strict=True))
    return HEADER.pack(*{**parts, field: value}.values()) + good[HEADER_BYTES:]


@given(
    raw=arrays(np.uint32, st.tuples(st.integers(1, 20), st.just(VALUES_PER_FRAME))),
    epoch=st.integers(0, 2**32 - 1),
    phase_id=st.integers(0, 2**31 - 1),
    seq=st.integers(0, 2**62 - 1),
    active_s=st.floats(0, 1e9),
    stream=st.sampled_from(BODY_STREAMS),
)
@settings(max_examples=60)
def test_a_batch_survives_encoding_and_decoding(
    raw: np.ndarray[tuple[int, int], np.dtype[np.uint32]],
    epoch: int,
    phase_id: int,
    seq: int,
    active_s: float,
    stream: StreamName,
) -> None:
    """Any bits of any frame and every header field survive encoding and decoding."""
    count = len(raw)
    batch = decode_batch(
        encode_batch(
            stream,
            epoch=epoch,
            phase_id=phase_id,
            seq_first=seq,
            times_s=np.linspace(0.0, 1.0, count, dtype=np.float64),
            flags=np.arange(count, dtype=np.uint8),
            values=raw.view(np.float32),
            active_s=active_s,
            closed_at_s=2.0,
        )
    )
    header = batch.header
    assert (header.stream, header.epoch, header.phase_id) == (stream, epoch, phase_id)
    assert (header.seq_first, header.seq_end) == (seq, seq + count)
    assert (header.active_s, header.closed_at_s) == (active_s, 2.0)
    assert np.array_equal(bits(batch.values), raw)
    assert np.array_equal(batch.times_s, np.linspace(0.0, 1.0, count))
    assert np.array_equal(batch.flags, np.arange(count))


def test_the_layout_is_the_documented_one() -> None:
    """Each field of a batch is at its documented offset, in little-endian."""
    sent = message(standing(3), epoch=7, phase_id=2, seq_first=90, active_s=1.5)
    assert sent[:4] == b"RMB1"
    assert struct.unpack_from("<HBB", sent, 4) == (64, 1, 0)
    assert struct.unpack_from("<IIQHH", sent, 8) == (7, 2, 90, 3, 91)
    assert struct.unpack_from("<I", sent, 28) == (zlib.crc32(sent[64:]),)
    assert struct.unpack_from("<d", sent, 32) == (1.5,)
    assert struct.unpack_from("<3d", sent, 64) == (1.0, 91 / 90, 92 / 90)
    assert struct.unpack_from("<8B", sent, 88) == (0,) * 8
    assert struct.unpack_from("<4f", sent, 96) == (0.0, 1.0, 0.0, 1.0)
    assert len(sent) == 96 + 3 * 91 * 4


def test_the_arrays_are_views_on_the_message() -> None:
    """Decoded arrays are views on the message, without a copy."""
    sent = message(standing(50))
    batch = decode_batch(sent)
    assert not batch.values.flags.owndata
    assert not batch.times_s.flags.owndata


@pytest.mark.parametrize(
    ("field", "value", "reason"),
    [
        ("magic", b"RMB2", "magic b'RMB2'"),
        ("length", 128, "header length 128"),
        ("stream", 5, "stream code 5"),
        ("stream", 0, "stream code 0"),
        ("n", 0, "frame count 0"),
        ("n", 1025, "frame count 1025"),
        ("n", 4, "4 frames need"),
        ("w", 92, "92 values per frame"),
        ("w", 0, "0 values per frame"),
        ("seq", 2**62, "seq"),
        ("seq", 2**64 - 1, "seq"),
        ("phase_id", 2**31, "phase_id 2147483648"),
        ("crc", 1, "checksum"),
        ("active_s", float("nan"), "active_s nan"),
        ("active_s", float("inf"), "active_s inf"),
        ("active_s", -0.5, "active_s -0.5"),
        ("closed_at_s", float("nan"), "closed_at_s nan"),
    ],
)
def test_an_invalid_header_is_rejected_by_field(field: str, value: object, reason: str) -> None:
    """An invalid header field raises an error that names the field and its value."""
    with pytest.raises(MalformedBatchError, match=reason):
        decode_batch(changed(field, value))


@pytest.mark.parametrize("length", [0, 1, 63, 64, 65, 1000])
def test_a_truncated_message_is_rejected(length: int) -> None:
    """A truncated batch is rejected as a whole."""
    with pytest.raises(MalformedBatchError, match=f"message of {length} bytes"):
        decode_batch(message(standing(3))[:length])


def test_a_message_with_extra_bytes_is_rejected() -> None:
    """A batch with bytes after the last frame is rejected."""
    with pytest.raises(MalformedBatchError):
        decode_batch(message(standing(3)) + b"\0")


@given(at=st.integers(HEADER_BYTES, len(message(standing(3))) - 1), flip=st.integers(1, 255))
def test_a_flipped_bit_in_the_body_is_detected(at: int, flip: int) -> None:
    """The checksum detects a flipped bit anywhere after the header."""
    broken = bytearray(message(standing(3)))
    broken[at] ^= flip
    with pytest.raises(MalformedBatchError, match="checksum"):
        decode_batch(bytes(broken))


@given(noise=st.binary(max_size=200))
@example(noise=b"RMB1")
@settings(max_examples=300)
def test_random_bytes_are_rejected(noise: bytes) -> None:
    """Arbitrary bytes raise MalformedBatchError, never another error."""
    with pytest.raises(MalformedBatchError):
        decode_batch(noise)


def test_thousands_of_mutations_raise_nothing_else() -> None:
    """A mutated batch is decoded or raises MalformedBatchError, never another error."""
    rng = np.random.default_rng(20260321)
    good = message(every_odd_float(), phase_id=1)
    refused = 0
    for _ in range(5000):
        broken = bytearray(good)
        for _ in range(rng.integers(1, 6)):
            kind, at = rng.integers(4), int(rng.integers(min(len(broken), 128) or 1))
            if kind == 0 and broken:
                broken[at] = int(rng.integers(256))
            elif kind == 1:
                del broken[at : at + int(rng.integers(1, 9))]
            elif kind == 2:
                broken[at:at] = rng.bytes(int(rng.integers(1, 9)))
            else:
                del broken[int(rng.integers(len(broken) + 1)) :]
        if rng.random() < 0.5 and len(broken) > HEADER_BYTES:
            # Half of them get a valid checksum, so that the checks after it are reached too.
            struct.pack_into("<I", broken, 28, zlib.crc32(broken[HEADER_BYTES:]))
        try:
            decode_batch(bytes(broken))
        except MalformedBatchError:
            refused += 1
    assert 4000 < refused < 5000


def test_frames_of_another_shape_cannot_be_encoded() -> None:
    """Frames of 90 values are rejected before anything is sent."""
    with pytest.raises(MalformedBatchError, match=r"\(n, 91\)"):
        message(np.zeros((3, 90), np.float32))
