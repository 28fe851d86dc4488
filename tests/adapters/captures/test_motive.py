"""Tests of reading Motive's CSV in every dialect: skeletons, rigid bodies and markers."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.adapters.captures import Capture, CaptureError, Reading, read_capture
from app.science.rig import BodyMotion, MarkerMotion, RigMotion
from app.science.rotations import geodesic_angle
from tests.adapters.captures.motive_texts import Dialect, motive_text
from tests.adapters.captures.moving_rigs import motive_body, random_motion, random_rig

_DIALECTS = {
    "1.21 without labels, CRLF": Dialect("1.21", labelled=False, line_end="\r\n"),
    "1.22 with Euler angles and nothing stated": Dialect(
        "1.22", rotation="XYZ", labelled=False, states_settings=False, mark=True
    ),
    "1.23 in millimetres, Chinese afternoon": Dialect(
        "1.23", units="Millimeters", start="2023-03-29 06.23.40.520 下午"
    ),
    "1.23 in Euler ZYX": Dialect("1.23", rotation="ZYX", units="Centimeters"),
    "1.24 with a time code": Dialect("1.24", timecode=True, units="Centimeters"),
    "1.25 with parents and trailing commas": Dialect(
        "1.25", parents=True, trailing_commas=400, units="Millimeters", markers=3
    ),
    "1.25 seen from the parents": Dialect("1.25", parents=True, space="Local", mark=True),
    "1.25 exported at a third of the rate": Dialect("1.25", parents=True, capture_rate_hz=360.0),
}


def _read(text: str, reading: Reading | None = None) -> Capture:
    return read_capture(text.encode(), name="take.csv", reading=reading or Reading())


def _rig_motion(capture: Capture) -> RigMotion:
    assert isinstance(capture.motion, RigMotion)
    return capture.motion


def _same_movement(found: RigMotion, expected: RigMotion, frames: slice = slice(None)) -> None:
    """Assert that every bone of `expected` has the same positions and rotations."""
    order = [found.rig.index(name) for name in expected.rig.names]
    places, turns = found.world()
    true_places, true_turns = expected.world()
    np.testing.assert_allclose(places[frames][:, order], true_places[frames], atol=1e-6)
    apart = geodesic_angle(turns[frames][:, order], true_turns[frames])
    assert float(np.max(apart)) < 1e-6


@pytest.mark.parametrize("fingers", [False, True], ids=["21 bones", "51 bones"])
@pytest.mark.parametrize("title", _DIALECTS)
def test_a_skeleton_comes_back_from_every_dialect(title: str, *, fingers: bool) -> None:
    """A movement written in any dialect is read back to a micrometre and a microradian."""
    rng = np.random.default_rng(21)
    motion = random_motion(rng, random_rig(rng, *motive_body(fingers=fingers)))
    capture = _read(motive_text(motion, _DIALECTS[title]))
    found = _rig_motion(capture)
    assert found.rate_hz == pytest.approx(120.0)
    assert set(found.rig.names) == set(motion.rig.names)
    assert found.observed.all()
    _same_movement(found, motion)


def test_conventions_are_marked_as_stated_or_guessed() -> None:
    """A 1.22 take states neither unit nor rotations, so both are marked as guessed."""
    rng = np.random.default_rng(22)
    motion = random_motion(rng, random_rig(rng, *motive_body()))
    silent = _read(motive_text(motion, _DIALECTS["1.22 with Euler angles and nothing stated"]))
    assert (silent.conventions.rotations.value, silent.conventions.rotations.origin) == (
        "Euler XYZ, degrees",
        "guessed",
    )
    assert (silent.conventions.length.value, silent.conventions.length.origin) == ("m", "guessed")
    stated = _read(motive_text(motion, Dialect(units="Millimeters")))
    assert (stated.conventions.length.value, stated.conventions.length.origin) == ("mm", "file")


def test_a_gap_is_filled_and_marked() -> None:
    """A bone that was not seen for some frames is interpolated and marked as not observed."""
    rng = np.random.default_rng(23)
    motion = random_motion(rng, random_rig(rng, *motive_body()))
    lost = ((10, 7), (11, 7), (12, 7), (13, 7), (0, 3), (39, 3))
    found = _rig_motion(_read(motive_text(motion, Dialect(missing=lost))))
    hidden = ~found.observed
    assert [(int(f), found.rig.names[int(j)]) for f, j in np.argwhere(hidden)] == [
        (0, "Neck"),
        *((frame, "LFArm") for frame in range(10, 14)),
        (39, "Neck"),
    ]
    whole = [frame for frame in range(40) if not hidden[frame].any()]
    places, _ = found.world()
    expected, _ = motion.world()
    order = [found.rig.index(name) for name in motion.rig.names]
    np.testing.assert_allclose(places[whole][:, order], expected[whole], atol=1e-6)
    # A thirtieth of a second is short, so the filled frames are close to the truth.
    assert float(np.abs(places[:, order] - expected).max()) < 0.02


def test_a_bone_that_stretches_gets_one_length_and_a_note() -> None:
    """A bone of varying length gets the median, with a note of the deviation."""
    rng = np.random.default_rng(24)
    motion = random_motion(rng, random_rig(rng, *motive_body()))
    text = motive_text(motion, Dialect(parents=True, version="1.25", space="Local"))
    lines = text.splitlines()
    names = lines[3].split(",")
    column = names.index("P01:Head") + 4
    cells = lines[20].split(",")
    cells[column] = f"{float(cells[column]) + 0.05:.9f}"
    lines[20] = ",".join(cells)
    capture = _read("\n".join(lines))
    _same_movement(_rig_motion(capture), motion)
    assert any("Head is off by up to 0.050 m" in note for note in capture.notes)


def test_of_two_people_in_a_take_the_first_is_read() -> None:
    """The first of two skeletons is read, and a note names the other."""
    rng = np.random.default_rng(25)
    motion = random_motion(rng, random_rig(rng, *motive_body()))
    one = motive_text(motion, Dialect(version="1.25", parents=True)).splitlines()
    other = motive_text(motion, Dialect(version="1.25", parents=True, asset="P02")).splitlines()
    both = [one[0], one[1]]
    both += [f"{a},{b.split(',', 2)[2]}" for a, b in zip(one[2:], other[2:], strict=True)]
    capture = _read("\n".join(both))
    _same_movement(_rig_motion(capture), motion)
    assert any("'P01' was read; also in the take: P02" in note for note in capture.notes)


def test_missing_frame_numbers_leave_a_gap() -> None:
    """Frames missing from the export are filled in and marked, since a rig has a constant rate."""
    rng = np.random.default_rng(26)
    motion = random_motion(rng, random_rig(rng, *motive_body()))
    lines = motive_text(motion, Dialect()).splitlines()
    first = next(n for n, line in enumerate(lines) if line.startswith("Frame")) + 1
    capture = _read("\n".join(lines[: first + 5] + lines[first + 8 :]))
    found = _rig_motion(capture)
    assert found.frame_count == 40
    assert np.flatnonzero(~found.observed.all(axis=1)).tolist() == [5, 6, 7]
    _same_movement(found, motion, slice(8, None))
    assert any("3 frames are missing" in note for note in capture.notes)


def test_bones_of_unknown_names_are_read_as_bodies() -> None:
    """Before 1.25 bones of unknown names, which have no hierarchy, are read as rigid bodies."""
    rng = np.random.default_rng(27)
    rig = random_rig(rng, ("Hip", "Tail", "Fin"), (-1, 0, 1))
    motion = random_motion(rng, rig)
    capture = _read(motive_text(motion, Dialect()))
    assert isinstance(capture.motion, BodyMotion)
    np.testing.assert_allclose(capture.motion.positions_m, motion.world()[0], atol=1e-6)
    with pytest.raises(CaptureError, match="Coordinate Space Global"):
        _read(motive_text(motion, Dialect(space="Local")))
    whole = _read(motive_text(motion, Dialect("1.25", parents=True)))
    _same_movement(_rig_motion(whole), motion)


def test_the_rigid_body_take_is_read(shared_data: Path) -> None:
    """A Motive 1.21 take has one rigid body, whose markers fit its frame."""
    path = shared_data / "motion" / "optitrack_csv" / "sample_optitrack_take.csv"
    capture = read_capture(path.read_bytes(), name=path.name)
    assert isinstance(capture.motion, BodyMotion)
    assert capture.motion.names == ("Rigid Body 1",)
    assert capture.motion.frame_count == 250
    assert capture.motion.rate_hz == pytest.approx(120.0)
    # Read off the last line: the body's place, quaternion x, y, z, w = (-41, -154, 22, -1e6) e-6.
    np.testing.assert_allclose(capture.motion.positions_m[-1, 0], (0.060349, 0.019146, 0.076408))
    np.testing.assert_allclose(capture.motion.rotations[-1, 0, 0], -1.0, atol=1e-6)
    assert any("marker" in note for note in capture.notes)


def test_markers_alone_are_read_as_markers(shared_data: Path) -> None:
    """Without bodies the labelled markers are read and the unlabelled ones left out."""
    path = shared_data / "motion" / "optitrack_csv" / "sample_optitrack_take.csv"
    rows = [line.split(",") for line in path.read_text().splitlines()]
    remaining = [0, 1, *(n for n, kind in enumerate(rows[2]) if kind == "Marker")]
    text = "\n".join(
        ",".join(row[n] for n in remaining if n < len(row)) if number > 1 else ",".join(row)
        for number, row in enumerate(rows)
    )
    capture = _read(text)
    assert isinstance(capture.motion, MarkerMotion)
    assert capture.motion.names == ("Marker1", "Marker2", "Marker3")
    np.testing.assert_allclose(capture.motion.positions_m[-1, 0], (0.010251, 0.019163, 0.009644))


def test_markers_of_one_name_are_numbered() -> None:
    """Markers with the same label, as after a loss, get numbers."""
    text = (
        "Format Version,1.23,Export Frame Rate,100,Length Units,Meters\n\n,Type"
        + ",Marker" * 9
        + "\n,Name,A,A,A,B,B,B,A,A,A\n,ID,1,1,1,2,2,2,3,3,3\n,"
        + ",Position" * 9
        + "\nFrame,Time (Seconds)"
        + ",X,Y,Z" * 3
        + "\n0,0.00,1,2,3,4,5,6,,,\n1,0.01,,,,4,5,6,1,2,3\n"
    )
    motion = _read(text).motion
    assert isinstance(motion, MarkerMotion)
    assert motion.names == ("A", "B", "A (2)")
    np.testing.assert_allclose(motion.positions_m[1, 2], (1.0, 2.0, 3.0))
    assert np.isnan(motion.positions_m[0, 2]).all()


def test_z_up_by_choice_turns_the_world() -> None:
    """An export with z up, read as such, gives the same movement as one with y up."""
    rng = np.random.default_rng(28)
    motion = random_motion(rng, random_rig(rng, *motive_body()))
    text = motive_text(motion, Dialect())
    plain = _rig_motion(_read(text))
    turned = _rig_motion(_read(text, Reading(up="z")))
    x, y, z = np.moveaxis(plain.world()[0], -1, 0)
    np.testing.assert_allclose(turned.world()[0], np.stack((x, z, -y), axis=-1), atol=1e-9)


_SMALL = Dialect("1.23")


@pytest.mark.parametrize(
    ("change", "reason", "line"),
    [
        (("Length Units,Meters", "Length Units,Furlongs"), "furlongs", 1),
        (("Frame,Time", "Fame,Time"), "no row begins with 'Frame'", 0),
        (("\n3,", "\nthree,"), "Frame is 'three'", 11),
        (("\n3,", "\n2,"), "frame 2 comes after frame 2", 11),
    ],
)
def test_an_invalid_take_is_rejected_with_its_line(
    change: tuple[str, str], reason: str, line: int
) -> None:
    """Each invalid line raises an error that states its number and content."""
    rng = np.random.default_rng(29)
    text = motive_text(random_motion(rng, random_rig(rng, *motive_body())), _SMALL)
    assert change[0] in text
    with pytest.raises(CaptureError, match=reason) as caught:
        _read(text.replace(*change, 1))
    assert caught.value.line == line


def test_a_quaternion_that_is_not_a_unit_is_rejected() -> None:
    """A quaternion of length 3 raises an error that states its line."""
    rng = np.random.default_rng(30)
    motion = random_motion(rng, random_rig(rng, *motive_body()))
    lines = motive_text(motion, replace(_SMALL)).splitlines()
    cells = lines[-1].split(",")
    cells[2:6] = ["3", "0", "0", "0"]
    with pytest.raises(CaptureError, match="P01:P01 has length 3") as caught:
        _read("\n".join([*lines[:-1], ",".join(cells)]))
    assert caught.value.line == len(lines)
