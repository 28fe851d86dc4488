"""Tests of the chunk encoding: lossless, checked for damage, readable from its document."""

import base64

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray

from app.features.record.telemetry.encoding import (
    ENCODING,
    DamagedChunkError,
    Frames,
    decode_frames,
    encode_frames,
)
from app.features.record.telemetry.encodings.integers import pack, unpack
from app.features.record.telemetry.encodings.unit_quaternions import choose
from app.wire import VALUES_PER_FRAME
from tests.features.record.telemetry.followed_movement import followed, made_movement
from tests.features.record.telemetry.plain_decoder import decode_plainly
from tests.support.repetitions import usually
from tests.wire.samples import bits, every_odd_float, standing

Words = NDArray[np.uint32]
BEFORE = "f32-columns-zstd/1"
# `sample()` as first written in each encoding, in base 85.
WRITTEN = {
    BEFORE: (
        "D77#BU<VKN1ps2l8zhiN9s8Y3{d^z^wR!fo2nTZuBQj})Xiv3P*CwaON5B97P64Xk+|5jeNvBo!QtVPEyk2Loa"
        "|<5~1;XG70sv=xlqFG?;2C)5RnDvM4b^C<23~<*wrSZWydr6eq~Q^G1cML^!XJ-yJQm&#9soF>s?f9mTM)>C2G"
        "|P+a|+~?VDkZp0BFn^f%B;fO$)FEfh=eM4j>fmIVEyRu=xN)z`@6vy{KSbw0JwHJO!u)5`wcq+ZD6{"
    ),
    "f32-predicted-zstd/1": (
        "kqS=V3jhEBTL5(c001bpFa2O{8(jkcWCH*Ie*ho=Hvj?v0RjUA1qKHQ2?_vg0Kotj0Biuk02Tl!0Du4i00I60{"
        "{I600RjL40RRC36ab$CK8yzipgnd94KM)h=|#<Z(O&JKN(e#4pkP2SC>RtB3I+uOMFmL%fHnYV`#>82000RZC="
        "xV3|NsC0|9}7hzyJS$00IC22mk-{000O"
    ),
}


def sample() -> tuple[NDArray[np.float64], NDArray[np.uint8], NDArray[np.float32]]:
    """Return the times, flags and values of a chunk with every kind of unusual float."""
    values = every_odd_float()
    count = len(values)
    return 5.0 + np.arange(count) / 90, np.arange(count, dtype=np.uint8), values


def read(data: bytes, count: int, *, encoding: str = ENCODING, width: int = 91) -> Frames:
    """Decode a chunk whose first seq is 7."""
    return decode_frames(
        data, encoding=encoding, seq_first=7, frame_count=count, values_per_frame=width
    )


def require_same(
    frames: Frames, times_s: NDArray[np.float64], flags: NDArray[np.uint8], words: Words
) -> None:
    """Require the same bits; bits are compared because NaNs are not equal to themselves."""
    assert frames.times_s.tobytes() == times_s.tobytes()
    assert frames.flags.tobytes() == flags.tobytes()
    assert np.array_equal(bits(frames.values), words)


@st.composite
def chunks(draw: st.DrawFn) -> tuple[NDArray[np.float64], NDArray[np.uint8], Words]:
    """Draw standing, moving or random frames, with arbitrary words in a few places."""
    count = draw(st.integers(1, 30))
    kind = draw(st.sampled_from(["standing", "moving", "anything"]))
    if kind == "anything":
        words = draw(arrays(np.uint32, (count, VALUES_PER_FRAME)))
    else:
        rng = np.random.default_rng(draw(st.integers(0, 1000)))
        moving = followed(made_movement(count / 90, rng), rng).actual
        words = bits(standing(count) if kind == "standing" else moving).copy()
        at = st.tuples(st.integers(0, count - 1), st.integers(0, VALUES_PER_FRAME - 1))
        for where, word in draw(st.dictionaries(at, st.integers(0, 2**32 - 1))).items():
            words[where] = word
    times = draw(arrays(np.uint64, count) | st.just(np.arange(count, dtype=np.uint64)))
    return times.view(np.float64), draw(arrays(np.uint8, count)), words


@given(chunk=chunks())
@settings(max_examples=usually(50, at_length=150), deadline=None)
def test_encoding_is_lossless(
    chunk: tuple[NDArray[np.float64], NDArray[np.uint8], Words],
) -> None:
    """Encoding keeps any bits of times, flags and values, whatever they mean as numbers."""
    times_s, flags, words = chunk
    data = encode_frames(times_s, flags, words.view(np.float32))
    frames = read(data, len(words))
    require_same(frames, times_s, flags, words)
    assert frames.seq.tolist() == list(range(7, 7 + len(words)))


@pytest.mark.parametrize("count", [1, 2, 3, 4, 5, 90, 1024, 4000])
def test_a_chunk_may_have_any_length(count: int) -> None:
    """A chunk may have from one to several thousand frames."""
    rng = np.random.default_rng(count)
    moving = followed(made_movement(count / 90, rng), rng)
    flags = np.ones(count, np.uint8)
    frames = read(encode_frames(moving.times_s, flags, moving.actual), count)
    require_same(frames, moving.times_s, flags, bits(moving.actual))


@given(chunk=chunks())
@settings(max_examples=usually(10, at_length=30), deadline=None)
def test_the_document_is_enough_to_read_a_chunk(
    chunk: tuple[NDArray[np.float64], NDArray[np.uint8], Words],
) -> None:
    """A decoder written from the document alone, without numpy, reads the same chunk."""
    times_s, flags, words = chunk
    plain = decode_plainly(encode_frames(times_s, flags, words.view(np.float32)))
    assert plain.values == words.tolist()
    assert plain.flags == flags.tolist()
    assert plain.times == times_s.view(np.uint64).tolist()


@pytest.mark.parametrize("encoding", WRITTEN)
def test_stored_chunks_of_every_encoding_can_be_read(encoding: str) -> None:
    """Stored chunks of every encoding that was ever used give the same frames."""
    times_s, flags, values = sample()
    frames = read(base64.b85decode(WRITTEN[encoding]), len(flags), encoding=encoding)
    require_same(frames, times_s, flags, bits(values))


def test_the_current_encoding_has_a_stored_sample() -> None:
    """The current encoding is among those with a stored sample chunk."""
    assert ENCODING in WRITTEN


@given(
    numbers=st.lists(
        st.integers(0, 32).flatmap(lambda w: st.tuples(st.integers(0, 2**w - 1), st.just(w)))
    )
)
def test_bit_fields_hold_any_widths(numbers: list[tuple[int, int]]) -> None:
    """Numbers of 0 to 32 bits are packed without gaps and read back from any position."""
    values = np.array([number for number, _ in numbers], np.uint32)
    widths = np.array([width for _, width in numbers], np.int64)
    data = pack(values, widths)
    assert len(data) == -(-int(widths.sum()) // 8)
    half = len(widths) // 2
    assert np.array_equal(unpack(data, widths), values)
    assert np.array_equal(unpack(data, widths[half:], int(widths[:half].sum())), values[half:])


def test_the_fourth_component_follows_from_three() -> None:
    """The omitted component of a quaternion is within two float32 steps of its prediction."""
    rng = np.random.default_rng(4)
    rows = bits(followed(made_movement(2.0, rng), rng).actual.T)
    left_out = choose(rows)
    steps = rows[left_out.rows] - left_out.expected(rows[left_out.kept_rows])
    assert np.abs(steps.view(np.int32)).max() <= 2


@given(at=st.floats(0, 1, exclude_max=True), change=st.integers(1, 255))
def test_a_changed_byte_is_detected(at: float, change: int) -> None:
    """Changing any byte of a chunk raises an error that says what to do."""
    times_s, flags, values = sample()
    damaged = bytearray(encode_frames(times_s, flags, values))
    damaged[int(at * len(damaged))] ^= change
    with pytest.raises(DamagedChunkError, match=r"checksum .* restore it from a backup"):
        read(bytes(damaged), len(flags))


@pytest.mark.parametrize("encoding", WRITTEN)
@pytest.mark.parametrize("length", [0, 3, 13, 14, 100])
def test_a_truncated_chunk_is_detected(encoding: str, length: int) -> None:
    """A truncated chunk is reported as damaged in every encoding."""
    data = base64.b85decode(WRITTEN[encoding])[:length]
    with pytest.raises(DamagedChunkError):
        read(data, 11, encoding=encoding)


@pytest.mark.parametrize("encoding", WRITTEN)
@pytest.mark.parametrize(("count", "width"), [(10, 91), (12, 91), (11, 87)])
def test_a_chunk_with_wrong_counts_is_detected(encoding: str, count: int, width: int) -> None:
    """A chunk is damaged if its row has other counts of frames or values."""
    with pytest.raises(DamagedChunkError):
        read(base64.b85decode(WRITTEN[encoding]), count, encoding=encoding, width=width)


@pytest.mark.parametrize("shape", [(0, 91), (3, 90), (3, 2)])
def test_encoding_no_frames_or_partial_quaternions_is_refused(shape: tuple[int, int]) -> None:
    """Encoding no frames, or values that are not a root and whole quaternions, is an error."""
    count = shape[0]
    with pytest.raises(ValueError, match="expected"):
        encode_frames(np.zeros(count), np.zeros(count, np.uint8), np.zeros(shape, np.float32))
