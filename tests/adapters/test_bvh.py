"""Tests of reading and writing BVH."""

import csv
from pathlib import Path

import numpy as np
import pytest

from app.adapters.bvh import BvhError, BvhLimits, format_bvh, parse_bvh, read_bvh
from app.science import rotations as rot

_SMALL = """HIERARCHY
ROOT Hips
{
  OFFSET 0 1 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Yrotation Xrotation
  JOINT Upper Arm
  {
    OFFSET 1 0 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0.5 0 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.01
0 2 0 90 0 0 0 0 0
0 2 0 0 0 0 10 20 30
"""


def test_joints_are_placed_where_the_toolbox_author_placed_them(shared_data: Path) -> None:
    """World positions of walk01 agree with the table that its author computed (bvh-toolbox)."""
    folder = shared_data / "motion" / "bvh_toolbox"
    clip = read_bvh(folder / "walk01.bvh", metres_per_unit=1.0)
    positions, _ = clip.world()
    with (folder / "walk01_pos.csv").open(newline="") as file:
        table = list(csv.DictReader(file))
    for joint, name in enumerate(clip.names):
        expected = [[float(row[f"{name}.{axis}"]) for axis in "xyz"] for row in table]
        np.testing.assert_allclose(positions[:, joint], expected, atol=1e-5)


@pytest.mark.parametrize("name", ["02_01", "05_06", "06_01", "12_02"])
def test_cmu_captures_are_read(shared_data: Path, name: str) -> None:
    """The CMU walks have 31 joints at 120 frames a second and human leg lengths."""
    path = shared_data / "motion" / "cmu_bvh" / f"{name}.bvh"
    clip = read_bvh(path, metres_per_unit=0.056444)
    assert len(clip.names) == 31
    assert clip.frame_time_s == pytest.approx(1 / 120, abs=1e-6)
    assert rot.is_unit(clip.rotations, 1e-9).all()
    shin = np.linalg.norm(clip.offsets_m[clip.names.index("LeftFoot")])
    assert 0.35 < float(shin) < 0.55


def test_vicon_capture_has_its_own_order_at_the_root(shared_data: Path) -> None:
    """A root that turns ZYX above joints that turn ZXY is read as declared."""
    path = shared_data / "motion" / "vicon_tracker" / "HumanRobotHandover_0.bvh"
    clip = read_bvh(path, metres_per_unit=0.001)
    assert clip.channels[0][3:] == ("Zrotation", "Yrotation", "Xrotation")
    assert clip.channels[1] == ("Zrotation", "Xrotation", "Yrotation")
    assert clip.frame_count == 1451


def test_small_text_is_read_as_written() -> None:
    """Names with spaces, units, position channels and rotation orders are read correctly."""
    clip = parse_bvh("\ufeff" + _SMALL.replace("\n", "\r\n"), metres_per_unit=0.01)
    assert clip.names == ("Hips", "Upper Arm")
    assert clip.parents == (-1, 0)
    assert clip.end_sites == ((1, (0.005, 0.0, 0.0)),)
    assert clip.duration_s == pytest.approx(0.01)
    np.testing.assert_allclose(clip.root_positions_m, [[0, 0.02, 0], [0, 0.02, 0]])
    positions, _ = clip.world()
    # A quarter turn about z carries the arm's offset from x to y.
    np.testing.assert_allclose(positions[0, 1], (0.0, 0.03, 0.0), atol=1e-15)
    expected = rot.from_euler("ZXY", np.radians((10.0, 20.0, 30.0)))
    assert float(rot.geodesic_angle(clip.rotations[1, 1], expected)) < 1e-12


def test_writing_and_reading_back_gives_the_same_poses(shared_data: Path) -> None:
    """A clip is the same after writing it as text and reading it back."""
    path = shared_data / "motion" / "bvh_toolbox" / "walk01.bvh"
    clip = read_bvh(path, metres_per_unit=0.01)
    reread = parse_bvh(format_bvh(clip, metres_per_unit=0.01), metres_per_unit=0.01)
    assert reread.names == clip.names
    assert [joint for joint, _ in reread.end_sites] == [joint for joint, _ in clip.end_sites]
    np.testing.assert_allclose([o for _, o in reread.end_sites], [o for _, o in clip.end_sites])
    np.testing.assert_allclose(reread.translations_m, clip.translations_m, atol=1e-9)
    assert float(np.max(rot.geodesic_angle(reread.rotations, clip.rotations))) < 1e-9


@pytest.mark.parametrize(
    ("old", "new", "line", "reason"),
    [
        ("HIERARCHY", "HELLO", 1, "expected 'HIERARCHY'"),
        ("OFFSET 1 0 0", "OFFSET 1 zero 0", 8, "the Y offset"),
        ("OFFSET 1 0 0", "OFFSET 1 inf 0", 8, "only finite"),
        ("CHANNELS 3 Z", "CHANNELS 9 Z", 9, "0 to 6"),
        ("3 Zrotation Xrotation", "3 Zrotation Wrotation", 9, "unknown channel"),
        ("3 Zrotation Xrotation", "3 Zrotation Zrotation", 9, "repeated channel"),
        ("JOINT Upper Arm", "JOINT Hips", 6, "a name of its own"),
        ("JOINT Upper Arm", "BONE Upper Arm", 6, "expected JOINT"),
        ("MOTION", "ROOT Other", 16, "second ROOT"),
        ("Frames: 2", "Frames: two", 17, "whole number"),
        ("Frames: 2", "Frames: 0", 17, "whole number"),
        ("Frames: 2", "Frames: 3", 20, "declares 3"),
        ("Frames: 2", "Frames: 1", 20, "declares 1"),
        ("Frame Time: 0.01", "Frame Time: 0", 18, "above zero"),
        ("Frame Time: 0.01", "Time: 0.01", 18, "frame time:"),
        ("0 2 0 90 0 0 0 0 0", "0 2 0 90 0 0 0 0", 19, "8 values"),
        ("10 20 30", "10 nan 30", 20, "only finite"),
        ("10 20 30", "10 x 30", 20, "got 'x'"),
    ],
)
def test_an_invalid_text_is_rejected_with_its_line(
    old: str, new: str, line: int, reason: str
) -> None:
    """Each invalid line raises an error that states its number and what is valid."""
    assert old in _SMALL
    with pytest.raises(BvhError, match=reason) as caught:
        parse_bvh(_SMALL.replace(old, new, 1), metres_per_unit=0.01)
    assert caught.value.line == line


@pytest.mark.parametrize("cut", [0, 10, 60, 150, 250, 300])
def test_a_truncated_text_is_rejected(cut: int) -> None:
    """A text that ends early raises an error instead of giving a partial clip."""
    with pytest.raises(BvhError):
        parse_bvh(_SMALL[:cut], metres_per_unit=0.01)


@pytest.mark.parametrize(
    "limits",
    [BvhLimits(characters=100), BvhLimits(joints=1), BvhLimits(depth=1), BvhLimits(values=17)],
)
def test_texts_beyond_a_limit_are_rejected(limits: BvhLimits) -> None:
    """Texts with too many bytes, joints, levels or values are rejected."""
    with pytest.raises(BvhError):
        parse_bvh(_SMALL, metres_per_unit=0.01, limits=limits)


def test_units_must_be_a_length() -> None:
    """A unit of zero length is rejected."""
    with pytest.raises(BvhError, match="metres_per_unit"):
        parse_bvh(_SMALL, metres_per_unit=0.0)
