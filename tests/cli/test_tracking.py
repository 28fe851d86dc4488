"""Tests of `reembody tracking align`: figures, a moved foot, and refusals."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.cli.tracking.inputs import COLUMNS, read_poses, write_poses
from app.science.alignment import PoseStream
from app.science.rotations import from_rotation_vector, multiply, rotate
from tests.cli.invoked import Invoked
from tests.science.alignment.rooms import (
    FOOT_FROM_HEAD_M,
    OPTICAL,
    in_tracking_world,
    joined,
    looking_around,
    moved_world,
    recorded,
    some_room,
)

_COMMAND = Invoked("tracking")
_RECENTRE_S = 20.3
_TURN = from_rotation_vector(np.array((0.0, 0.6, 0.0)))
_SHIFT_M = np.array((0.4, 0.0, -0.3))


class Recording:
    """The files of a headset that is recentred, of the tracker on it, and of a foot's."""

    def __init__(self, folder: Path, seconds: float) -> None:
        rng = np.random.default_rng(3)
        self.head, self.room = looking_around(seconds), some_room(rng)
        headset, tracker = recorded(self.head, self.room, OPTICAL, rng)
        recentred = moved_world(headset, _TURN, _SHIFT_M)
        self.headset, self.tracker, self.foot = (
            folder / name for name in ("headset.csv", "tracker.csv", "foot.csv")
        )
        write_poses(self.headset, joined(headset, recentred, _RECENTRE_S))
        write_poses(self.tracker, tracker)
        feet = self.head.positions_m + np.array(FOOT_FROM_HEAD_M)
        seen = in_tracking_world(self.room, self.head.times_s, feet)
        times_s = self.head.times_s + self.room.delay_s
        write_poses(self.foot, replace(self.head, times_s=times_s, positions_m=seen))


@pytest.fixture(scope="module")
def recording(tmp_path_factory: pytest.TempPathFactory) -> Recording:
    """Provide 35 s of looking around with a recentre."""
    return Recording(tmp_path_factory.mktemp("recorded"), 35.0)


def test_a_foot_is_moved_to_where_the_headset_would_see_it(
    recording: Recording, tmp_path: Path
) -> None:
    """Before and after a recentre, the written foot is at the right place at the right time."""
    out = tmp_path / "moved.csv"
    found = _COMMAND.figures(
        "align", recording.headset, recording.tracker, "--move", recording.foot, "--out", out
    )
    changes = [one["change"] for one in found["changes"]]
    assert [one for one in changes if one != "refit"] == ["first", "lost", "recentred"]
    assert found["alignment"]["delay_s"] == pytest.approx(recording.room.delay_s, abs=0.001)
    expected = multiply(_TURN, recording.room.rotation)
    assert (
        abs(np.dot(found["alignment"]["headset_from_tracking"]["rotation_wxyz"], expected))
        > 1 - 1e-6
    )
    moved = read_poses(out)
    assert found["moved"]["written"] == len(moved.times_s)
    assert found["moved"]["left_out"] <= 2
    feet_m = recording.head.at(moved.times_s)[0] + np.array(FOOT_FROM_HEAD_M)
    after = (moved.times_s >= _RECENTRE_S)[:, np.newaxis]
    feet_m = np.where(after, rotate(_TURN, feet_m) + _SHIFT_M, feet_m)
    away_m = np.linalg.norm(moved.positions_m - feet_m, axis=1)
    near = np.abs(moved.times_s - _RECENTRE_S) > 0.02
    assert float(away_m[near].max()) < 0.005


def test_the_text_says_what_happened_and_how_good_it_is(recording: Recording) -> None:
    """The text names the recentre, the delay, the residual and the error to expect of a foot."""
    said = _COMMAND.run("align", recording.headset, recording.tracker).stdout
    for words in (
        "the headset was recentred",
        "(by 0.4",
        "degrees at 20.3",
        "aligned again after the headset was recentred",
        "delay       30.0 ms",
        "1.6 m from the head",
        "left and right",
    ):
        assert words in said


def test_a_short_recording_is_aligned_at_once(tmp_path: Path) -> None:
    """Six seconds are too short to be followed, but enough for one fit."""
    short = Recording(tmp_path, 6.0)
    found = _COMMAND.figures("align", short.headset, short.tracker)
    assert [one["change"] for one in found["changes"]] == ["first"]
    assert found["alignment"]["uncertainty_m"] < 0.003


def test_what_cannot_be_used_is_refused(recording: Recording, tmp_path: Path) -> None:
    """Files and options that cannot be used are refused with the place and the remedy."""
    lines = recording.tracker.read_text().splitlines()
    bad, still = tmp_path / "bad.csv", tmp_path / "still.csv"
    for text, words in (
        ("\n".join([lines[0].replace("qw", "w"), *lines[1:]]), "the columns qw are missing"),
        ("\n".join([*lines[:5], "1,2,three,4,5,6,7,8,1"]), "line 6: '1,2,three"),
        ("\n".join([*lines[:5], lines[4]]), "not later than the one before"),
        (lines[0], "each needs 2 or more"),
        ("", "the columns time_s"),
    ):
        bad.write_text(text)
        assert words in _COMMAND.refusal("align", recording.headset, bad), words
    head = read_poses(recording.headset)
    frozen = np.tile((1.0, 0.0, 0.0, 0.0), (len(head.times_s), 1))
    write_poses(still, replace(head, rotations=frozen))
    assert "look around" in _COMMAND.refusal("align", still, recording.tracker)
    assert "there is no file" in _COMMAND.refusal("align", tmp_path / "none.csv", bad)
    refused = _COMMAND.refusal("align", recording.headset, recording.tracker, "--move", bad)
    assert "--move and --out are needed together" in refused


def test_poses_are_written_without_rounding(tmp_path: Path) -> None:
    """What is written is read back to the last bit, guessed samples included."""
    rng = np.random.default_rng(1)
    q = from_rotation_vector(rng.normal(size=(20, 3)))
    poses = PoseStream.of(
        np.sort(rng.normal(size=20)), rng.normal(size=(20, 3)), q, [0.0, 1.0] * 10
    )
    write_poses(tmp_path / "poses.csv", poses)
    again = read_poses(tmp_path / "poses.csv")
    np.testing.assert_array_equal(again.times_s, poses.times_s)
    np.testing.assert_array_equal(again.positions_m, poses.positions_m)
    np.testing.assert_allclose(again.rotations, poses.rotations, atol=1e-15)
    np.testing.assert_array_equal(again.weights, poses.weights)
    with (tmp_path / "poses.csv").open() as file:
        assert tuple(next(csv.reader(file))) == (*COLUMNS, "tracked")
