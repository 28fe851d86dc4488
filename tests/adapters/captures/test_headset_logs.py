"""Tests of reading logs of headsets: UXF's trackers from Unity, and the Quest's own."""

from pathlib import Path

import numpy as np
import pytest

from app.adapters.captures import Capture, CaptureError, read_capture
from app.science.rig import BodyMotion
from app.science.rotations import FloatArray, from_rotation_vector, rotate

_UXF = "time,pos_x,pos_y,pos_z,rot_x,rot_y,rot_z\n"


def _bodies(capture: Capture) -> BodyMotion:
    assert isinstance(capture.motion, BodyMotion)
    return capture.motion


def _uxf(text: str, name: str = "head_movement_T001.csv") -> BodyMotion:
    return _bodies(read_capture(text.encode(), name=name))


def _unity_turn(degrees: tuple[float, float, float], vector: FloatArray) -> FloatArray:
    """Return Unity's documented rotation by matrices: z, then x, then y, left-handed."""
    x, y, z = np.radians(degrees)
    about_z = np.array(((np.cos(z), -np.sin(z), 0), (np.sin(z), np.cos(z), 0), (0, 0, 1)))
    about_x = np.array(((1, 0, 0), (0, np.cos(x), -np.sin(x)), (0, np.sin(x), np.cos(x))))
    about_y = np.array(((np.cos(y), 0, np.sin(y)), (0, 1, 0), (-np.sin(y), 0, np.cos(y))))
    turned: FloatArray = about_y @ about_x @ about_z @ vector
    return turned


@pytest.mark.parametrize("degrees", [(30.0, 0.0, 0.0), (10.0, 200.0, 350.0), (89.0, 12.0, 77.0)])
def test_unitys_angles_turn_as_unity_does(degrees: tuple[float, float, float]) -> None:
    """Turning a vector by Unity's angles and mirroring it equals our converted rotation."""
    motion = _uxf(_UXF + f"3.5,1,2,3,{degrees[0]},{degrees[1]},{degrees[2]}\n")
    assert motion.names == ("head",)
    np.testing.assert_allclose(motion.positions_m[0, 0], (1.0, 2.0, -3.0))
    mirror = np.array((1.0, 1.0, -1.0))
    for vector in np.eye(3):
        expected = mirror * _unity_turn(degrees, vector)
        np.testing.assert_allclose(
            rotate(motion.rotations[0, 0], mirror * vector), expected, atol=1e-12
        )


def test_looking_right_in_unity_is_looking_right_here() -> None:
    """Unity's +90 degrees about y, from +z to +x, turn our forward -z to +x."""
    motion = _uxf(_UXF + "0,0,1.6,0,0,90,0\n")
    ahead = rotate(motion.rotations[0, 0], np.array((0.0, 0.0, -1.0)))
    np.testing.assert_allclose(ahead, (1.0, 0.0, 0.0), atol=1e-12)


def test_a_german_log_is_read() -> None:
    """A UXF log with semicolons between columns and decimal commas is read."""
    text = "time;pos_x;pos_y;pos_z;rot_x;rot_y;rot_z\n1,5;0,25;1,5;-0,5;0;90;0\n1,6;0,3;1;0;0;0;0\n"
    motion = _uxf(text)
    np.testing.assert_allclose(motion.positions_m[0, 0], (0.25, 1.5, 0.5))
    np.testing.assert_allclose(motion.times_s, (0.0, 0.1))


def test_all_zeros_means_not_tracked() -> None:
    """A controller whose values are all zero was not tracked."""
    capture = read_capture((_UXF + "1,0,0,0,0,0,0\n2,1,2,3,0,0,0\n").encode(), name="left.csv")
    motion = _bodies(capture)
    assert np.isnan(motion.positions_m[0]).all()
    assert np.isnan(motion.rotations[0]).all()
    assert np.isfinite(motion.rotations[1]).all()
    assert any(note.startswith("left was not tracked in 1 of 2") for note in capture.notes)


def test_quaternions_of_a_labs_own_tracker_are_read() -> None:
    """Columns rot_x to rot_w are read as quaternions and mirrored like angles."""
    half = float(np.sqrt(0.5))
    text = "time,h_pos_x,h_pos_y,h_pos_z,h_rot_x,h_rot_y,h_rot_z,h_rot_w\n"
    motion = _uxf(text + f"0,0,1,0,0,{half},0,{half}\n")
    expected = from_rotation_vector(np.array((0.0, -np.pi / 2.0, 0.0)))
    np.testing.assert_allclose(motion.rotations[0, 0], expected, atol=1e-12)


def test_the_published_tracker_is_read(shared_data: Path) -> None:
    """The published log has a head and two controllers at 90 Hz, the left one never tracked."""
    path = shared_data / "logs/uxf/kitchen_laser/10/S001/trackers/VR_move_T003.csv"
    capture = read_capture(path.read_bytes(), name=path.name)
    motion = _bodies(capture)
    assert motion.names == ("head", "left", "right")
    assert motion.rate_hz == pytest.approx(90.0, abs=0.1)
    assert motion.times_s[0] == 0.0
    assert np.isnan(motion.positions_m[:, 1]).all()
    assert 1.2 < float(np.median(motion.positions_m[:, 0, 1])) < 1.9
    # Heads are held up: their y axis stays within 80 degrees of the vertical.
    upright = rotate(motion.rotations[:, 0], np.array((0.0, 1.0, 0.0)))[:, 1]
    assert float(upright.min()) > np.cos(np.radians(80.0))
    assert any("grab_force" in note for note in capture.notes)


def test_a_gaze_log_is_rejected(shared_data: Path) -> None:
    """A log of gaze rays raises an error that lists the columns that a body needs."""
    path = shared_data / "logs/uxf/kitchen_laser/10/S001/trackers/Eye_gaze_T003.csv"
    with pytest.raises(CaptureError, match=r"dir_x.*A tracker of movement has pos_x"):
        read_capture(path.read_bytes(), name=path.name)


def test_the_quest_log_is_read(shared_data: Path) -> None:
    """The Quest's log, two minutes at 60 Hz, is read as w, x, y, z, which makes heads upright."""
    path = shared_data / "logs" / "quest_log" / "sample_movement_data.csv"
    capture = read_capture(path.read_bytes(), name=path.name)
    motion = _bodies(capture)
    assert motion.names == ("LeftTouch", "RightTouch", "Head")
    assert motion.frame_count == 7942
    assert motion.rate_hz == pytest.approx(59.88, abs=0.01)
    assert float(motion.times_s[-1]) == pytest.approx(132.349 - 0.0169733)
    head = motion.rotations[:, 2]
    assert float(np.median(rotate(head, np.array((0.0, 1.0, 0.0)))[:, 1])) > 0.85
    assert any(note.startswith("LeftTouch keeps one pose") for note in capture.notes)


def test_a_quote_in_a_labs_own_column_is_a_character() -> None:
    """A quote in a UXF log, which has no quoting, does not swallow the following rows."""
    text = _UXF.replace("rot_z\n", "rot_z,said\n") + '1,0,1,0,0,0,0,"yes\n2,0,1,0,0,0,0,no\n'
    assert _uxf(text).frame_count == 2


def test_times_must_increase() -> None:
    """Repeated times are dropped with a note; a time that goes back is rejected."""
    capture = read_capture(
        (_UXF + "1,0,1,0,0,0,0\n1,0,1,0,0,0,0\n2,0,1,0,0,0,0\n").encode(), name="a.csv"
    )
    assert capture.motion.frame_count == 2
    assert any("1 rows repeat the time" in note for note in capture.notes)
    with pytest.raises(CaptureError, match="the time goes back") as caught:
        _uxf(_UXF + "1,0,1,0,0,0,0\n0.5,0,1,0,0,0,0\n")
    assert caught.value.line == 3


@pytest.mark.parametrize(
    ("text", "reason", "line"),
    [
        (_UXF, "no row of numbers", 0),
        (_UXF + "1,2,3\n", "3 cells in this row, 7 are needed", 2),
        (_UXF + "1,a,3,4,5,6,7\n", "pos_x is 'a'", 2),
        (_UXF + ",1,3,4,5,6,7\n", "the time is nan", 2),
        (_UXF + "1,1e9,3,4,5,6,7\n", "up to 100000 m", 2),
        ("time,pos_x,pos_y,rot_x\n1,2,3,4\n", "no body has a place", 1),
        ("HeadPosX,HeadOrientationW\n1,2\n", "a log needs the columns", 1),
    ],
)
def test_an_invalid_log_is_rejected_with_its_line(text: str, reason: str, line: int) -> None:
    """Each invalid line raises an error that states its number and content."""
    with pytest.raises(CaptureError, match=reason) as caught:
        read_capture(text.encode(), name="a.csv")
    assert caught.value.line == line
