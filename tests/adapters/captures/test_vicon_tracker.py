"""Tests of reading Vicon Tracker's CSV: rotation vectors, z up, objects that disappear."""

from itertools import permutations
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from app.adapters.captures import Capture, CaptureError, Reading, read_capture
from app.science.rig import BodyMotion, RigMotion
from app.science.rotations import FloatArray, conjugate, from_rotation_vector, rotate

_TEXT = """Objects
100
,,Global Angle hip:hip,,,,,,Global Angle a:head,,,,,
Frame,Sub Frame,RX,RY,RZ,TX,TY,TZ,RX,RY,RZ,TX,TY,TZ
,,rad,rad,rad,mm,mm,mm,rad,rad,rad,mm,mm,mm
5,0,0,0,1.5,1000,2000,3000,0,0,0,10,20,30
6,0,0,0,1.6,1000,2000,3000,,,,,,
8,0,0,0,1.7,1000,2000,3000,0,0,0,10,20,30

"""


def _bodies(capture: Capture) -> BodyMotion:
    assert isinstance(capture.motion, BodyMotion)
    return capture.motion


def test_z_up_becomes_y_up_and_gaps_stay_gaps() -> None:
    """Positions and rotations become y up, frames keep their times, and gaps stay gaps."""
    capture = read_capture(("\ufeff" + _TEXT).encode(), name="take.csv")
    motion = _bodies(capture)
    assert motion.names == ("hip", "a:head")
    np.testing.assert_allclose(motion.times_s, (0.0, 0.01, 0.03))
    np.testing.assert_allclose(motion.positions_m[0, 0], (1.0, 3.0, -2.0), atol=1e-12)
    # A rotation about the file's z is one about our y.
    expected = from_rotation_vector(np.array((0.0, 1.5, 0.0)))
    np.testing.assert_allclose(motion.rotations[0, 0], expected, atol=1e-12)
    assert np.isnan(motion.positions_m[1, 1]).all()
    assert np.isnan(motion.rotations[1, 1]).all()
    assert "Not seen: a:head in 1 of 3 frames." in capture.notes
    assert capture.conventions.axes.value == "z up, right-handed"


def test_y_up_by_choice_leaves_the_axes() -> None:
    """An up axis that the user chose overrides the format's, and y up changes no axes."""
    motion = _bodies(read_capture(_TEXT.encode(), name="take.csv", reading=Reading(up="y")))
    np.testing.assert_allclose(motion.positions_m[0, 0], (1.0, 2.0, 3.0))


def _scatter(turns: FloatArray, places: FloatArray) -> float:
    """Return how far a second body moves in the first one's frame, relative to their distance."""
    within = rotate(conjugate(turns), places)
    wander = np.linalg.norm(within - np.median(within, axis=0), axis=-1)
    return float(np.mean(wander) / np.mean(np.linalg.norm(places, axis=-1)))


def test_the_angles_are_rotation_vectors(shared_data: Path) -> None:
    """Vicon's angles are rotation vectors; in any Euler order a hand would leave its elbow."""
    path = shared_data / "motion" / "vicon_tracker" / "HumanRobotHandover_0.csv"
    motion = _bodies(read_capture(path.read_bytes(), name=path.name))
    elbow, hand = motion.names.index("left_elbow"), motion.names.index("left_hand")
    apart = motion.positions_m[:, hand] - motion.positions_m[:, elbow]
    seen = ~np.isnan(apart).any(axis=-1)
    assert _scatter(motion.rotations[seen, elbow], apart[seen]) < 0.035
    rows = [line.split(",") for line in path.read_text("utf-8-sig").splitlines()[5:] if line]
    first = 2 + 6 * elbow
    stated = np.array([[float(cell or "nan") for cell in row[first : first + 3]] for row in rows])
    to_ours = Rotation.from_rotvec((-np.pi / 2.0, 0.0, 0.0))
    for order in ("".join(axes) for axes in permutations("XYZ")):
        columns = ["XYZ".index(axis) for axis in order]
        turn = to_ours * Rotation.from_euler(order, stated[seen][:, columns]) * to_ours.inv()
        scatter = _scatter(turn.as_quat(scalar_first=True), apart[seen])
        assert scatter > 0.07, f"Euler {order} would fit as well: {scatter}"


@pytest.mark.parametrize("take", ["HumanRobotHandover_0", "ObjectInspection_0"])
def test_the_hip_walks_as_in_the_authors_bvh(shared_data: Path, take: str) -> None:
    """Each root position of the authors' BVH, which drops frames, occurs in ours, to 5 mm."""
    folder = shared_data / "motion" / "vicon_tracker"
    csv, bvh = (
        read_capture((folder / f"{take}.{kind}").read_bytes(), name=f"{take}.{kind}").motion
        for kind in ("csv", "bvh")
    )
    assert isinstance(csv, BodyMotion)
    assert isinstance(bvh, RigMotion)
    hip = csv.positions_m[:, csv.names.index("hip")]
    apart = np.linalg.norm(bvh.root_positions_m[::10, None] - hip[None], axis=-1).min(axis=1)
    assert float(apart.max()) < 0.005


@pytest.mark.parametrize(
    ("old", "new", "reason", "line"),
    [
        ("\n100\n", "\nfast\n", "the rate is 'fast'", 2),
        ("\n100\n", "\n0\n", "the rate is '0'", 2),
        ("a:head", "hip:hip", "missing or repeated", 3),
        ("TZ,RX", "RX,TZ", "not RX, RY, RZ", 4),
        ("rad,rad,rad,mm", "rad,grad,rad,mm", "units are", 5),
        ("\n6,0,", "\n5,0,", "frame 5 comes after frame 5", 7),
        ("1.6,1000", "1.6,x", "TX of hip is 'x'", 7),
        ("1.6,1000", "1.6,inf", "TX of hip is infinite", 7),
        ("1.6,1000", "1.6,1e12", "hip is at 1e.09 m", 7),
        ("10,20,30\n\n", "10,20\n\n", "TZ of a:head is missing", 8),
    ],
)
def test_an_invalid_table_is_rejected_with_its_line(
    old: str, new: str, reason: str, line: int
) -> None:
    """Each invalid line raises an error that states its number and what is valid."""
    assert old in _TEXT
    with pytest.raises(CaptureError, match=reason) as caught:
        read_capture(_TEXT.replace(old, new, 1).encode(), name="take.csv")
    assert caught.value.line == line
