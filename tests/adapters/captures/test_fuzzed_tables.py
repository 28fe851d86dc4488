"""Tests that damaged tables and BVH files are read or rejected, within bounds of memory."""

import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.adapters.captures import CaptureError, Limits, read_capture, to_bvh
from tests.adapters.captures.fuzzing import assert_survives, read_or_reject
from tests.adapters.captures.moving_rigs import motive_body, random_motion, random_rig
from tests.adapters.captures.seeds import table_seeds

pytestmark = pytest.mark.thorough

# Together with the marker formats: 2,500.
_SHORT = {
    "bvh": 500,
    "motive-csv": 500,
    "vicon-tracker-csv": 300,
    "uxf-tracker": 300,
    "quest-log": 175,
}
_SEEDS = table_seeds()


@pytest.mark.parametrize("key", _SEEDS)
def test_damaged_files_are_read_or_rejected(key: str) -> None:
    """Hundreds of damaged files of each format are read or rejected with a `CaptureError`."""
    name, seeds = _SEEDS[key]
    assert_survives(seeds, name, _SHORT[key])


@pytest.mark.long
@pytest.mark.parametrize("key", _SEEDS)
def test_many_damaged_files_are_read_or_rejected(key: str) -> None:
    """Eighty times as many damaged files as in the short test are read or rejected."""
    name, seeds = _SEEDS[key]
    assert_survives(seeds, name, 80 * _SHORT[key])


@settings(max_examples=400, deadline=None, derandomize=True, database=None)
@given(data=st.binary(max_size=400), name=st.sampled_from([name for name, _ in _SEEDS.values()]))
def test_random_bytes_are_rejected(data: bytes, name: str) -> None:
    """Random bytes are rejected by every format."""
    assert read_or_reject(data, name) is None


_BOMBS = {
    "frames that are not there": (
        "HIERARCHY\nROOT a\n{\nOFFSET 0 1 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n}\n"
        "MOTION\nFrames: 20000000\nFrame Time: 0.01\n0 0 0\n"
    ),
    "one channel for many joints": "HIERARCHY\nROOT a\n{\nOFFSET 0 1 0\nCHANNELS 1 Zrotation\n"
    + "".join(f"JOINT j{n}\n{{\nOFFSET 0 1 0\nCHANNELS 0\n}}\n" for n in range(190))
    + "}\nMOTION\nFrames: 300000\nFrame Time: 0.01\n"
    + "0\n" * 300_000,
    "a gap of millions of frames": _SEEDS["motive-csv"][1][0]
    .decode()
    .replace("\n3,", "\n900000000,"),
    "nothing but commas": "Format Version,1.23\n" + ("," * 100_000 + "\n") * 30,
    "nothing but lines": "HIERARCHY\n" + "\n" * 400_000,
    "one endless line": "HIERARCHY\nROOT " + "a " * 1_500_000,
    "a quote that never ends": 'time,pos_x,pos_y,pos_z,rot_x,rot_y,rot_z\n"' + "1,\n" * 900_000,
}


def test_reading_takes_a_few_times_the_memory_of_the_movement() -> None:
    """Reading 5,000 poses of 21 joints peaks below five times their memory."""
    rng = np.random.default_rng(33)
    data = to_bvh(random_motion(rng, random_rig(rng, *motive_body()), frames=5_000)).encode()
    tracemalloc.start()
    try:
        motion = read_capture(data, name="long.bvh").motion
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert motion.frame_count == 5_000
    movement_bytes = 8 * 5_000 * (21 * 4 + 3)
    assert peak < 5 * movement_bytes, f"{peak / movement_bytes:.1f} times"


@pytest.mark.parametrize("title", _BOMBS)
def test_memory_stays_within_bounds_whatever_a_file_claims(title: str) -> None:
    """Malicious files of three megabytes are rejected with less than 100 MB of memory."""
    data = _BOMBS[title].encode()
    tracemalloc.start()
    try:
        with pytest.raises(CaptureError):
            read_capture(data, name="a.csv", limits=Limits(values=4_000_000))
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 100e6, f"{peak / 1e6:.0f} MB"
