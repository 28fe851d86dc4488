"""Thousands of damaged capture files: each gives a capture or a `CaptureError`.

Each example takes a small valid file and damages it as disks, editors, converters and attackers do;
`assert_survives` reads all of them with `read_capture`.
"""

import re
import warnings
from collections.abc import Mapping, Sequence

from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from app.adapters.captures import Capture, CaptureError, Limits, Reading, read_capture

LIMITS = Limits(bytes=400_000, tracks=200, depth=16, values=400_000)
"""Low limits, so that a reader that ignores them fails soon."""

_NUMBER = re.compile(rb"-?\d+\.?\d*(?:[eE][-+]?\d+)?")
_ODD_NUMBERS = (
    b"",
    b"nan",
    b"inf",
    b"-inf",
    b"1e308",
    b"-1e308",
    b"1e-320",
    b"0",
    b"-0",
    b"-1",
    b"999999999999999999999999",
    b"2147483648",
    b"1e5",
    b"0x10",
    b"1_0",
    b"1,5",
    b"x",
    "٣".encode(),
)
_ODD_BYTES = (b"\x00", b"\xff", b'"', b"\n", b"\r", b",", b";", b"\t", b"{", b"}", b":", b"#", b" ")


def assert_survives(seeds: Sequence[bytes], name: str, examples: int) -> None:
    """Read damaged versions of the seeds, which must give captures or errors.

    Args:
        seeds: small valid files of one format.
        name: a file name with the format's extension.
        examples: number of damaged versions.
    """
    assert_family_survives([({}, seed) for seed in seeds], name, examples)


def assert_family_survives(
    seeds: Sequence[tuple[Mapping[str, bytes], bytes]], name: str, examples: int
) -> None:
    """Read damaged versions of seeds with companion files, damaged in one case of three."""
    for companions, seed in seeds:
        # A seed that is rejected undamaged would only test the first check.
        read_capture(seed, name=name, reading=Reading(companions=companions), limits=LIMITS)

    @settings(
        max_examples=examples,
        deadline=None,
        database=None,
        derandomize=True,
        suppress_health_check=list(HealthCheck),
    )
    @given(st.data())
    def survive(data: st.DataObject) -> None:
        companions, seed = data.draw(st.sampled_from(seeds))
        if companions and data.draw(st.integers(0, 2)) == 0:
            which = data.draw(st.sampled_from(sorted(companions)))
            companions = {**companions, which: data.draw(damaged(companions[which]))}
        else:
            seed = data.draw(damaged(seed))
        read_or_reject(seed, name, companions)

    survive()


def read_or_reject(
    data: bytes, name: str, companions: Mapping[str, bytes] | None = None
) -> Capture | None:
    """Read a file and return None if it is properly rejected; a warning is a failure."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            reading = Reading(companions=companions or {})
            return read_capture(data, name=name, reading=reading, limits=LIMITS)
        except CaptureError as error:
            if not error.reason:
                raise
            return None


@st.composite
def damaged(draw: st.DrawFn, seed: bytes) -> bytes:
    """Damage a valid file one to three times."""
    data = seed
    for _ in range(draw(st.integers(1, 3))):
        damage = draw(st.sampled_from(_DAMAGES))
        data = damage(draw, data)
    return data


def _cut(draw: st.DrawFn, data: bytes) -> bytes:
    return data[: draw(st.integers(0, len(data)))]


def _headless(draw: st.DrawFn, data: bytes) -> bytes:
    return data[draw(st.integers(0, len(data))) :]


def _flip(draw: st.DrawFn, data: bytes) -> bytes:
    if not data:
        return data
    changed = bytearray(data)
    for at in draw(st.lists(st.integers(0, len(data) - 1), min_size=1, max_size=8)):
        changed[at] = draw(st.integers(0, 255))
    return bytes(changed)


def _other_number(draw: st.DrawFn, data: bytes) -> bytes:
    found = list(_NUMBER.finditer(data))
    if not found:
        return data
    number = found[draw(st.integers(0, len(found) - 1))]
    return data[: number.start()] + draw(st.sampled_from(_ODD_NUMBERS)) + data[number.end() :]


def _insert(draw: st.DrawFn, data: bytes) -> bytes:
    at = draw(st.integers(0, len(data)))
    odd = draw(st.sampled_from(_ODD_BYTES)) * draw(st.sampled_from((1, 1, 1, 40, 5000)))
    return data[:at] + odd + data[at:]


def _lines(draw: st.DrawFn, data: bytes) -> bytes:
    """Drop, duplicate, move or repeat lines."""
    lines = data.split(b"\n")
    first = draw(st.integers(0, len(lines) - 1))
    last = min(len(lines), first + draw(st.integers(1, 5)))
    some = lines[first:last]
    match draw(st.integers(0, 3)):
        case 0:
            changed = lines[:first] + lines[last:]
        case 1:
            changed = lines[:last] + some + lines[last:]
        case 2:
            rest = lines[:first] + lines[last:]
            at = draw(st.integers(0, len(rest)))
            changed = rest[:at] + some + rest[at:]
        case _:
            changed = lines[:last] + some * 100 + lines[last:]
    return b"\n".join(changed)


def _noise(draw: st.DrawFn, data: bytes) -> bytes:
    """Keep the beginning, by which the format is detected, and append random bytes."""
    keep = draw(st.integers(0, min(len(data), 300)))
    return data[:keep] + draw(st.binary(max_size=200))


def _word(draw: st.DrawFn, data: bytes) -> bytes:
    """Replace one word of the file by another."""
    words = list(re.finditer(rb"[^\s,;]+", data))
    if len(words) < 2:
        return data
    here = words[draw(st.integers(0, len(words) - 1))]
    other = words[draw(st.integers(0, len(words) - 1))]
    return data[: here.start()] + other.group() + data[here.end() :]


_DAMAGES = (_cut, _headless, _flip, _other_number, _other_number, _insert, _lines, _noise, _word)
