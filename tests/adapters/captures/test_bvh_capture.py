"""Tests of BVH as a capture: units, axes, rest rows and joints with position channels."""

import csv
from pathlib import Path

import numpy as np
import pytest

from app.adapters.captures import Capture, CaptureError, Limits, Reading, read_capture
from app.science.rig import RigMotion
from app.science.rotations import FloatArray, rotate

_TEXT = """HIERARCHY
ROOT Hips
{
  OFFSET 0 90 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Head
  {
    OFFSET 0 110 0
    CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 10 0
    }
  }
}
MOTION
Frames: 3
Frame Time: 0.01
0 90 0 0 0 0 0 110 0 0 0 0
0 90 5 10 0 0 0 110 0 0 0 0
0 90 9 20 0 0 0 112 0 0 0 0
"""


def _read(text: str, reading: Reading | None = None) -> Capture:
    return read_capture(text.encode(), name="walk.bvh", reading=reading or Reading())


def _motion(capture: Capture) -> RigMotion:
    assert isinstance(capture.motion, RigMotion)
    return capture.motion


def _published_positions(path: Path, rig: RigMotion) -> tuple[FloatArray, FloatArray]:
    """Return the positions of joints and ends as their author computed them."""
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    ends = [f"{rig.rig.names[joint]}_End" for joint, _ in rig.rig.ends]

    def column(names: list[str]) -> FloatArray:
        return np.array([[[float(row[f"{n}.{a}"]) for a in "xyz"] for n in names] for row in rows])

    return column(list(rig.rig.names)), column(ends)


def test_positions_equal_those_of_the_toolbox(shared_data: Path) -> None:
    """Joint positions of walk01 equal those of bvh-toolbox's author to 1e-5 of its unit."""
    folder = shared_data / "motion" / "bvh_toolbox"
    data = (folder / "walk01.bvh").read_bytes()
    motion = _motion(read_capture(data, name="walk01.bvh", reading=Reading(metres_per_unit=1.0)))
    joints, ends = _published_positions(folder / "walk01_pos.csv", motion)
    places, turns = motion.world()
    np.testing.assert_allclose(places, joints, atol=1.0e-5)
    for end, (joint, offset) in enumerate(motion.rig.ends):
        tip = places[:, joint] + rotate(turns[:, joint], np.array(offset))
        np.testing.assert_allclose(tip, ends[:, end], atol=1.0e-5)


@pytest.mark.parametrize(
    ("file", "unit", "height_m"),
    [
        ("bvh_toolbox/walk01.bvh", "cm", 1.85),
        ("cmu_bvh/05_06.bvh", "0.056444 m", 1.43),
        ("vicon_tracker/ObjectInspection_0.bvh", "mm", 1.30),
    ],
)
def test_the_unit_is_guessed_from_the_height_of_the_body(
    shared_data: Path, file: str, unit: str, height_m: float
) -> None:
    """Without a stated unit, the one that gives a human height is used and marked as guessed."""
    path = shared_data / "motion" / file
    capture = read_capture(path.read_bytes(), name=path.name)
    assert (capture.conventions.length.value, capture.conventions.length.origin) == (
        unit,
        "guessed",
    )
    assert any(f"{height_m:.2f} m" in note for note in capture.notes)


def test_the_rest_row_of_the_converted_captures_is_left_out(shared_data: Path) -> None:
    """The T-pose at the start of 05_06 is left out; 02_01 has none."""
    folder = shared_data / "motion" / "cmu_bvh"
    with_row = read_capture((folder / "05_06.bvh").read_bytes(), name="05_06.bvh")
    assert _motion(with_row).frame_count == 885
    assert any("rest pose put before" in note for note in with_row.notes)
    without = read_capture((folder / "02_01.bvh").read_bytes(), name="02_01.bvh")
    assert _motion(without).frame_count == 343


def test_the_users_choice_overrides_the_guess() -> None:
    """A unit or an axis that the user chose overrides the guess and is marked as chosen."""
    plain = _motion(_read(_TEXT)).world()[0]
    capture = _read(_TEXT, Reading(metres_per_unit=0.02, up="z"))
    assert capture.conventions.length.origin == capture.conventions.axes.origin == "chosen"
    x, y, z = np.moveaxis(_motion(capture).world()[0], -1, 0)
    np.testing.assert_allclose(np.stack((x, -z, y), axis=-1), 2.0 * plain, atol=1e-12)


def test_a_figure_on_its_back_raises_a_doubt() -> None:
    """A body that is deeper than high gets a note about the up axis and is not turned."""
    lying = _TEXT.replace("OFFSET 0 110 0", "OFFSET 0 0 110").replace(
        "OFFSET 0 10 0", "OFFSET 0 0 10"
    )
    assert any("choose z as upward axis" in note for note in _read(lying).notes)
    assert not any("upward axis" in note for note in _read(_TEXT).notes)
    assert not any("upward axis" in note for note in _read(lying, Reading(up="z")).notes)


def test_a_joint_with_positions_gets_their_median_as_its_bone() -> None:
    """A joint with position channels gets their median as its bone; the deviation is noted."""
    capture = _read(_TEXT)
    np.testing.assert_allclose(_motion(capture).rig.offsets_m[1], (0.0, 1.1, 0.0))
    assert any("Head leaves by up to 0.0200 m" in note for note in capture.notes)


def test_ends_of_bones_are_kept() -> None:
    """An End Site becomes the free end of its joint's bone, in metres."""
    rig = _motion(_read(_TEXT)).rig
    assert rig.ends == ((1, (0.0, 0.1, 0.0)),)


def test_a_body_of_no_human_size_is_read_with_a_warning() -> None:
    """A body whose size is human in no unit is read in the closest unit, with a note."""
    capture = _read(_TEXT.replace("110", "0.7").replace("OFFSET 0 10", "OFFSET 0 0.1"))
    assert any("Say the unit" in note for note in capture.notes)


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ("0 90 5 10", "0 1e300 5 10", "up to 100000 m is plausible"),
        ("OFFSET 0 110 0", "OFFSET 0 1e200 0", "up to 100000 m is plausible"),
        ("Frame Time: 0.01", "Frame Time: 1e-30", "0.000010 to 1000 s is valid"),
        ("Frames: 3", "Frames: 99999999999", "too many"),
        ("Zrotation Xrotation Yrotation\n  JOINT", "Wrotation\n  JOINT", "unknown channel"),
    ],
)
def test_impossible_captures_are_rejected(old: str, new: str, reason: str) -> None:
    """Impossible sizes, rates and counts raise errors instead of arithmetic warnings."""
    assert old in _TEXT
    with pytest.raises(CaptureError, match=reason):
        _read(_TEXT.replace(old, new, 1))


def test_limits_are_enforced_before_memory_is_allocated() -> None:
    """Numbers of joints, levels and values are checked before memory is allocated."""
    for limits, reason in (
        (Limits(tracks=1), "more than 1 joints"),
        (Limits(depth=1), "deeper than 1"),
        (Limits(values=40), "too many"),
        (Limits(bytes=100), "up to 100 are read"),
    ):
        with pytest.raises(CaptureError, match=reason):
            read_capture(_TEXT.encode(), name="walk.bvh", limits=limits)
