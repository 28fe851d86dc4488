"""The JSON door for scripts: what it takes, and what it refuses."""

import json

import pytest

from app.adapters.live import JsonTrackers
from app.adapters.live.readings import MAX_POSES

GOOD = {
    "source": "my script",
    "time_s": 12.5,
    "frame": 7,
    "trackers": {
        "left foot": {"position_m": [0.1, 0.9, -0.2], "rotation_wxyz": [0, 0, 1, 0]},
        "lost": {"position_m": [0, 0, 0], "tracked": False},
    },
}


def test_a_packet_is_taken_as_it_is() -> None:
    """Metres and w, x, y, z need no conversion; whole numbers are numbers too."""
    reading = JsonTrackers().read(json.dumps(GOOD).encode())
    assert (reading.source, reading.time_s, reading.frame) == ("my script", 12.5, 7)
    foot, lost = reading.poses
    assert (foot.position_m, foot.rotation) == ((0.1, 0.9, -0.2), (0, 0, 1, 0))
    assert (lost.rotation, lost.tracked, reading.problems) == (None, False, {})


@pytest.mark.parametrize(
    ("packet", "problem"),
    [
        (b"", "malformed"),
        (b"\xff\xfe", "malformed"),
        (b'{"source": "x"', "malformed"),
        (b"[" * 60_000, "malformed"),
        (b"[]", "arguments"),
        (b'{"trackers": {}}', "arguments"),
        (b'{"source": "x", "trackers": {}, "postion": 1}', "arguments"),
        (b'{"source": "", "trackers": {}}', "arguments"),
        (b'{"source": "x", "time_s": 1e13, "trackers": {}}', "number"),
        (b'{"source": "x", "frame": -1, "trackers": {}}', "arguments"),
        (b'{"source": "x", "frame": 1' + b"0" * 5000 + b', "trackers": {}}', "malformed"),
        (b'{"source": "x", "trackers": {"a": {}}}', "arguments"),
        (b'{"source": "x", "trackers": {"a": {"position_m": [1, 2]}}}', "arguments"),
        (b'{"source": "x", "trackers": {"a": {"position_m": ["1", 2, 3]}}}', "arguments"),
        (b'{"source": "x", "trackers": {"a": {"position_m": [1e400, 2, 3]}}}', "number"),
        (b'{"source": "x", "trackers": {"a": {"position_m": [NaN, 2, 3]}}}', "number"),
        (b'{"source": "x", "trackers": {"a": {"rotation_wxyz": [0, 0, 0, 0]}}}', "number"),
        (json.dumps({**GOOD, "source": "n" * 65}).encode(), "limit"),
    ],
)
def test_what_cannot_be_used_is_counted_by_kind(packet: bytes, problem: str) -> None:
    """No packet raises, and each is counted once."""
    reading = JsonTrackers().read(packet)
    assert (reading.poses, reading.problems) == ((), {problem: 1})


def test_a_packet_has_a_limited_number_of_trackers() -> None:
    """What is over the limit is counted."""
    trackers = {str(one): {"position_m": [0, 0, 0]} for one in range(MAX_POSES + 3)}
    reading = JsonTrackers().read(json.dumps({"source": "x", "trackers": trackers}).encode())
    assert (len(reading.poses), reading.problems) == (MAX_POSES, {"limit": 3})
