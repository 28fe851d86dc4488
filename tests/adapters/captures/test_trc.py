"""Tests of reading TRC, a text table of markers."""

from pathlib import Path

import numpy as np
import pytest

from app.adapters.captures import Capture, CaptureError, Limits, Reading
from app.adapters.captures.trc import read_trc
from app.science.rig import MarkerMotion
from tests.adapters.captures.marker_seeds import TRC as _SMALL


def _read(text: str, reading: Reading | None = None, limits: Limits | None = None) -> Capture:
    return read_trc(
        text.encode(), name="small.trc", reading=reading or Reading(), limits=limits or Limits()
    )


def _markers(capture: Capture) -> MarkerMotion:
    assert isinstance(capture.motion, MarkerMotion)
    return capture.motion


def test_a_small_table_is_read_as_written() -> None:
    """Centimetres become metres, and an empty cell is an unseen marker."""
    capture = _read(_SMALL)
    motion = _markers(capture)
    assert (motion.names, motion.rate_hz) == (("Head", "Foot"), 100.0)
    np.testing.assert_allclose(
        motion.positions_m[:, 0], [[0, 1.7, 0], [0.01, 1.7, 0], [0.02, 1.7, 0]]
    )
    assert np.isnan(motion.positions_m[1, 1]).all()
    assert (capture.conventions.length.value, capture.conventions.length.origin) == ("cm", "file")
    assert (capture.conventions.axes.value, capture.conventions.axes.origin) == (
        "y up, right-handed",
        "guessed",
    )


def test_line_ends_and_marks_of_other_systems_change_nothing() -> None:
    """Windows line ends, a byte order mark and a missing blank line make no difference."""
    other = "\ufeff" + _SMALL.replace("Z2\n\n", "Z2\n").replace("\n", "\r\n")
    np.testing.assert_array_equal(
        _markers(_read(other)).positions_m, _markers(_read(_SMALL)).positions_m
    )


def test_the_real_walk_has_the_markers_of_its_rows(shared_data: Path) -> None:
    """walk.trc, which names 55 markers, states 28 and has values for 28, in millimetres, y up."""
    data = (shared_data / "motion" / "trc" / "walk.trc").read_bytes()
    capture = read_trc(data, name="walk.trc", reading=Reading(), limits=Limits())
    motion = _markers(capture)
    assert motion.positions_m.shape == (184, 28, 3)
    assert (motion.names[0], motion.names[-1], motion.rate_hz) == ("R.ASIS", "L.MT2", 150.0)
    np.testing.assert_allclose(
        motion.positions_m[0, 0], (0.51654236, 0.966880, -0.30610416), atol=1e-9
    )
    assert "27 further names" in capture.notes[0]
    hips = motion.positions_m[:, motion.names.index("L.ASIS")]
    assert 0.9 < float(hips[:, 1].mean()) < 1.1


def test_a_missing_frame_number_is_an_unseen_frame() -> None:
    """A skipped frame number becomes an unseen frame, so the rate stays constant."""
    text = _SMALL.replace("3\t0.02", "5\t0.04")
    motion = _markers(_read(text))
    assert motion.frame_count == 5
    assert np.isnan(motion.positions_m[2:4]).all()


def test_a_wrong_count_of_frames_is_noted() -> None:
    """A NumFrames that differs from the number of rows is noted, and the rows are read."""
    capture = _read(_SMALL.replace("\t3\t2\tcm", "\t300\t2\tcm"))
    assert capture.motion.frame_count == 3
    assert any("300 frames" in note for note in capture.notes)


def test_the_up_axis_is_guessed_from_the_markers() -> None:
    """The axis of the markers' greatest extent is guessed to be up, unless one is chosen."""
    lying = _SMALL.replace("\t170\t0", "\t0\t170").replace("\t5\t0", "\t0\t5")
    capture = _read(lying)
    np.testing.assert_allclose(_markers(capture).positions_m[0, 0], (0.0, 1.7, 0.0), atol=1e-12)
    assert capture.conventions.axes.value == "z up, right-handed"
    chosen = _read(lying, Reading(up="y"))
    np.testing.assert_allclose(_markers(chosen).positions_m[0, 0], (0.0, 0.0, 1.7), atol=1e-12)


@pytest.mark.parametrize(
    ("old", "new", "line", "expected_message"),
    [
        ("PathFileType", "Something", 1, "PathFileType"),
        ("100.0\t100.0\t3", "-5\t100.0\t3", 3, "rate is -5"),
        ("\tcm\t", "\tparsec\t", 3, "parsec"),
        ("\t2\tcm", "\t9\tcm", 4, "9 markers"),
        ("1\t170\t0\t\t\t", "1\tmuch\t0\t\t\t", 8, "'much'"),
        ("2\t0.01", "1\t0.01", 8, "must rise"),
        ("2\t0.01", "x\t0.01", 8, "frame number"),
        ("12\t5\t0", "12\t5\t0\t8", 9, "more values"),
        ("3\t0.02", "99999999999\t0.02", 9, "frames of"),
    ],
)
def test_errors_are_reported_with_their_line(
    old: str, new: str, line: int, expected_message: str
) -> None:
    """Each error in a TRC is reported with its line."""
    assert old in _SMALL
    with pytest.raises(CaptureError, match=expected_message) as caught:
        _read(_SMALL.replace(old, new, 1))
    assert caught.value.line == line


def test_a_header_alone_is_rejected() -> None:
    """A table without rows is rejected."""
    with pytest.raises(CaptureError, match="no row"):
        _read(_SMALL.split("1\t0.00")[0])


def test_limits_are_enforced() -> None:
    """Too many markers are rejected at the line of their names."""
    with pytest.raises(CaptureError, match="more than 1 markers"):
        _read(_SMALL, limits=Limits(tracks=1))
