"""Tests of precision and recall of the fault detection on generated and captured movement."""

import sys
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from app.science import rotations as rot
from app.science.skeleton import JOINT_COUNT, JOINT_INDEX
from app.science.stream_quality import examine
from app.science.stream_quality.limits import TOES
from app.wire import flag_frames
from tests.science.stream_quality.recordings import (
    Found,
    Recording,
    captured,
    captures,
    compare,
    generated,
    jitter,
)

NEVER_MOVES = {JOINT_INDEX["LeftShoulder"], JOINT_INDEX["RightShoulder"], *TOES}
TRACKED = [joint for joint in range(JOINT_COUNT) if joint not in NEVER_MOVES]
DENORMAL = 1e-40
BAD_QUATERNIONS: dict[str, tuple[float, float, float, float]] = {
    "NaN": (np.nan, 0.0, 0.0, 0.0),
    "Inf": (1.0, np.inf, 0.0, 0.0),
    "-Inf": (-np.inf, 0.0, 0.0, 0.0),
    "zero": (0.0, 0.0, 0.0, 0.0),
    "denormal": (DENORMAL, DENORMAL, 0.0, 0.0),
    "non-unit": (0.9, 0.0, 0.43, 0.0),
    "huge": (3e38, 3e38, 3e38, 3e38),
}


@pytest.fixture
def recordings(shared_data: Path) -> list[Recording]:
    """Return generated and captured movement, without and with tracker noise."""
    rng = np.random.default_rng(20)
    plain = [generated(1), generated(2), *captures(shared_data)]
    return [*plain, *(jitter(one, rng) for one in plain)]


def test_every_bad_quaternion_is_flagged_and_no_good_one(
    recordings: list[Recording], capsys: pytest.CaptureFixture[str]
) -> None:
    """Bad quaternions are found with precision and recall 1, here and by `app.wire`."""
    rng = np.random.default_rng(19)
    lines = []
    for kind, quaternion in BAD_QUATERNIONS.items():
        total = Found(0, 0, 0)
        for recording in recordings:
            bad = recording.copy()
            frames = rng.choice(len(bad), 150, replace=False)
            bad.rotations[frames, rng.integers(JOINT_COUNT, size=150)] = quaternion
            there = np.isin(np.arange(len(bad)), frames)
            judged = examine(bad.times_s, bad.rotations, bad.positions_m)
            found = judged.non_finite | judged.non_unit
            values = np.concatenate((bad.positions_m, bad.rotations.reshape(len(bad), -1)), axis=1)
            on_the_wire = flag_frames(bad.times_s, values)
            assert np.array_equal(judged.non_finite, on_the_wire.non_finite)
            assert np.array_equal(judged.non_unit, on_the_wire.non_unit)
            total += compare(there, found)
        assert (total.precision, total.recall) == (1.0, 1.0), kind
        lines.append(total.line(f"{kind} quaternion"))
    print_figures(capsys, lines)


def test_jumps_are_found(recordings: list[Recording], capsys: pytest.CaptureFixture[str]) -> None:
    """Joints that turn by 30 to 180 degrees and hips that move 0.2 to 2 m in a frame are found."""
    rng = np.random.default_rng(21)
    turned, shifted = Found(0, 0, 0), Found(0, 0, 0)
    for recording in recordings:
        bad = recording.copy()
        frames = rng.choice(np.arange(2, len(bad)), 60, replace=False)
        there = np.zeros((len(bad), JOINT_COUNT), np.bool_)
        for frame in frames:
            joint = int(rng.integers(JOINT_COUNT))
            turn = rot.from_rotation_vector(_axis(rng) * np.radians(rng.uniform(60, 180)))
            after = bad.rotations[frame:, joint].astype(float)
            bad.rotations[frame:, joint] = rot.multiply(turn, after)
            there[frame, joint] = True
        places = rng.choice(np.arange(2, len(bad)), 60, replace=False)
        for frame in places:
            bad.positions_m[frame:] += _axis(rng) * rng.uniform(0.2, 2.0)
        judged = examine(bad.times_s, bad.rotations, bad.positions_m)
        turned += compare(there, judged.turned)
        shifted += compare(np.isin(np.arange(len(bad)), places), judged.shifted)
    print_figures(capsys, [turned.line("joint that jumps"), shifted.line("hips that jump")])
    for found in (turned, shifted):
        assert found.precision == 1.0
        assert found.recall == 1.0


def test_frozen_joints_are_found(
    recordings: list[Recording], capsys: pytest.CaptureFixture[str]
) -> None:
    """Up to four joints frozen for 1.2 to 8 s are all found if the others have tracker noise.

    Without noise a leg that a solver places rests now and then, and cannot be distinguished from a
    frozen one: nothing is reported then.
    """
    rng = np.random.default_rng(22)
    half = len(recordings) // 2
    smooth, trembling = (
        sum((_frozen(one, rng) for one in part for _ in range(6)), Found(0, 0, 0))
        for part in (recordings[:half], recordings[half:])
    )
    print_figures(
        capsys, [trembling.line("frozen joint, as tracked"), smooth.line("frozen joint, smooth")]
    )
    assert (trembling.precision, trembling.recall) == (1.0, 1.0)
    assert smooth.precision == 1.0
    assert smooth.recall >= 0.7


def _frozen(recording: Recording, rng: np.random.Generator) -> Found:
    bad = recording.copy()
    there = np.zeros((len(bad), JOINT_COUNT), np.bool_)
    for joint in rng.choice(TRACKED, rng.integers(1, 5), replace=False):
        first = int(rng.integers(600, len(bad) - 720))
        last = first + int(rng.uniform(1.2, 8.0) * 90)
        bad.rotations[first:last, joint] = bad.rotations[first, joint]
        there[first:last, joint] = True
    return _episodes(there, examine(bad.times_s, bad.rotations, bad.positions_m).frozen)


def test_movement_without_a_fault_raises_none(recordings: list[Recording]) -> None:
    """Four minutes of movement without faults raise no flag."""
    for recording in recordings:
        judged = examine(recording.times_s, recording.rotations, recording.positions_m)
        marks = (judged.non_finite, judged.non_unit, judged.turned, judged.shifted, judged.frozen)
        assert [int(mark.sum()) for mark in marks] == [0, 0, 0, 0, 0]
        assert not judged.pacing.gap.any()
        assert not judged.pacing.backwards.any()


def test_the_faults_of_a_faulty_capture_are_found(
    shared_data: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Feet that flip within a frame in a captured dance, at over 10,000 deg/s, are found."""
    dance = captured(shared_data / "motion" / "cmu_bvh" / "05_06.bvh")
    judged = examine(dance.times_s, dance.rotations, dance.positions_m)
    joints = set(np.flatnonzero(judged.turned.any(axis=0)).tolist())
    print_figures(capsys, [f"CMU 05_06: {int(judged.jumped.sum())} frames jump in {len(dance)}"])
    assert {JOINT_INDEX["LeftFoot"], JOINT_INDEX["RightFoot"]} <= joints


def _episodes(there: NDArray[np.bool_], found: NDArray[np.bool_]) -> Found:
    """Count frozen stretches that were inserted and found, and those found elsewhere."""
    hits = [bool(found[stretch].any()) for stretch in _stretches(there)]
    false = [not there[stretch].any() for stretch in _stretches(found)]
    return Found(len(hits), sum(hits), sum(false))


def _stretches(marks: NDArray[np.bool_]) -> list[tuple[slice, int]]:
    none = np.zeros((1, JOINT_COUNT), np.int8)
    edges = np.diff(marks.astype(np.int8), axis=0, prepend=none, append=none)
    begins, ends = np.argwhere(edges.T > 0), np.argwhere(edges.T < 0)
    return [(slice(a, b), joint) for (joint, a), (_, b) in zip(begins, ends, strict=True)]


def _axis(rng: np.random.Generator) -> NDArray[np.float64]:
    axis = rng.normal(size=3)
    return np.asarray(axis / np.linalg.norm(axis))


def print_figures(capsys: pytest.CaptureFixture[str], lines: list[str]) -> None:
    """Print the counts, precision and recall for the log."""
    with capsys.disabled():
        sys.stdout.write("\n" + "\n".join(lines) + "\n")
