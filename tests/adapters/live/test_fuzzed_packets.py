"""Damaged and invented packets: no decoder raises, hangs or grows."""

import gc
import json
import tracemalloc
from collections import Counter
from collections.abc import Callable, Iterator
from random import Random

import pytest

from app.adapters.live import Decoder, JsonTrackers, NatNetClient, OscTrackers
from app.adapters.live.readings import MAX_NAME, MAX_POSES
from tests.adapters.live.packets import Row, bundle, definitions, frame, osc, server_info, vmc
from tests.adapters.live.test_json_door import GOOD

ROWS: list[Row] = [(one, (0.1, 0.2, 0.3), (1.0, 0.0, 0.0, 0.0), True) for one in range(3)]
NAMES = {1: "Hip", 2: "Chest"}
SEEDS = {
    "osc": [
        bundle(vmc("LHR-1"), bundle(vmc("LeftFoot", what="Bone")), osc("/VMC/Ext/T", 1.5)),
        osc("/tracking/trackers/1/rotation", 1.0, 2.0, 3.0),
    ],
    "natnet": [
        part
        for version in ((2, 10), (3, 0), (4, 1))
        for part in (
            server_info(version),
            definitions(version, {1: "Waist"}, {2: ("Ann", NAMES)}),
            frame(version, 1, 2.0, ROWS, {2: ROWS}),
        )
    ],
    "json": [json.dumps(GOOD).encode()],
}
DECODERS: dict[str, Callable[[], Decoder]] = {
    "osc": OscTrackers,
    "natnet": NatNetClient,
    "json": JsonTrackers,
}
GROWTH_BYTES = 2**20
LARGEST = 65_507  # bytes of UDP over IPv4


def damaged(random: Random, seed: bytes) -> bytes:
    """Return a packet with bytes changed, cut, doubled, or all of them random."""
    data = bytearray(seed)
    match random.randrange(5):
        case 0:
            del data[random.randrange(len(data)) :]
        case 1:
            at = random.randrange(len(data))
            data[at:at] = data[at : at + random.randrange(64)]
        case 2:
            data = bytearray(random.randbytes(random.randrange(200)))
        case 3:  # an extreme number where a size may be
            at = random.randrange(len(data))
            data[at : at + 4] = random.choice((b"\xff" * 4, b"\xff\xff\xff\x7f", bytes(4)))
    for _ in range(random.randrange(4)):
        if data:
            data[random.randrange(len(data))] = random.randrange(256)
    return bytes(data)


def packets(kind: str, count: int, seed: int) -> Iterator[bytes]:
    """Yield damaged packets of a kind; now and then an intact one, so that state is at risk too."""
    random = Random(seed)  # noqa: S311 - repeatable damage, no secret
    for number in range(count):
        chosen = random.choice(SEEDS[kind])
        yield chosen if number % 50 == 0 else damaged(random, chosen)


def check(kind: str, count: int, seed: int) -> None:
    """Read damaged packets with one decoder, which keeps its state."""
    decoder = DECODERS[kind]()
    problems: Counter[str] = Counter()
    for packet in packets(kind, 500, seed):  # so that caches are full before memory is measured
        decoder.read(packet)
    tracemalloc.start()
    try:
        for packet in packets(kind, count, seed + 1):
            reading = decoder.read(packet)
            problems += reading.problems
            assert len(reading.poses) <= MAX_POSES
            assert all(0 < len(one.tracker) <= MAX_NAME for one in reading.poses)
        # The interpreter keeps freed tuples and floats for reuse, more the longer it runs; here it
        # gives them back, because they are not the decoder's.
        gc.collect()
        held, _ = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert problems["malformed"] > count // 20
    assert held < GROWTH_BYTES


@pytest.mark.thorough
@pytest.mark.parametrize("kind", list(SEEDS))
def test_damaged_packets_are_counted_and_nothing_grows(kind: str) -> None:
    """20,000 packets over the three doors, the same ones in every run."""
    check(kind, 7_000, seed=23)


@pytest.mark.long
@pytest.mark.timeout(3600)  # a busy machine traces the memory of 200 packets a second
@pytest.mark.thorough
@pytest.mark.parametrize("kind", list(SEEDS))
def test_a_million_damaged_packets(kind: str) -> None:
    """10^6 packets over the three doors."""
    check(kind, 334_000, seed=2023)


@pytest.mark.parametrize("kind", list(SEEDS))
def test_the_largest_packets_are_read_within_limits(kind: str) -> None:
    """A datagram full of the smallest items, or of one byte, gives no more than the limits."""
    small: Row = (1, (0, 0, 0), (1, 0, 0, 0), True)
    most = {
        "osc": bundle(*[osc("/a")] * ((LARGEST - 16) // 12)),
        "natnet": frame((3, 0), 1, 2.0, [(one, *small[1:]) for one in range(1700)]),
        "json": json.dumps(
            {"source": "x", "trackers": {str(one): {} for one in range(4000)}}
        ).encode(),
    }[kind]
    assert len(most) <= LARGEST
    decoder = DECODERS[kind]()
    decoder.read(server_info((3, 0)))
    assert decoder.read(most).problems.keys() <= {"limit", "unused", "arguments"}
    for byte in range(256):
        reading = decoder.read(bytes([byte]) * LARGEST)
        assert len(reading.poses) <= MAX_POSES
