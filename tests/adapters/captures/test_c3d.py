"""Tests of reading C3D, the binary files of marker systems."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
import pytest

from app.adapters.captures import Capture, CaptureError, Limits, Reading
from app.adapters.captures.c3d import read_c3d
from app.science.rig import MarkerMotion
from tests.adapters.captures.c3d_files import DEC, INTEL, MIPS, C3dFile

_REAL_FILES = ("cmu_c3d/02_01.c3d", "c3d/Gait.c3d", "c3d/walkingOptiTrack.c3d")


def _read(data: bytes, reading: Reading | None = None, limits: Limits | None = None) -> Capture:
    return read_c3d(data, name="some.c3d", reading=reading or Reading(), limits=limits or Limits())


def _markers(capture: Capture) -> MarkerMotion:
    assert isinstance(capture.motion, MarkerMotion)
    return capture.motion


def _some_places(frames: int = 7, markers: int = 3) -> npt.NDArray[np.float64]:
    rng = np.random.default_rng(5)
    places = rng.uniform(-1500.0, 1500.0, (frames, markers, 3))
    places[1:2, 2:] = np.nan
    return places


def _standing(places_mm: npt.NDArray[np.float64]) -> npt.NDArray[np.float64]:
    """Convert positions from z up in millimetres to y up in metres."""
    return np.stack((places_mm[..., 0], places_mm[..., 2], -places_mm[..., 1]), -1) / 1000.0


@pytest.mark.parametrize("path", _REAL_FILES)
def test_real_files_are_read_as_ezc3d_reads_them(shared_data: Path, path: str) -> None:
    """Positions and unseen markers agree with the independent reader ezc3d to a nanometre."""
    ezc3d = pytest.importorskip("ezc3d")
    file = shared_data / "motion" / path
    theirs = ezc3d.c3d(str(file))["data"]["points"][:3].transpose(2, 1, 0)
    ours = _markers(_read(file.read_bytes())).positions_m
    np.testing.assert_array_equal(np.isnan(ours), np.isnan(theirs))
    np.testing.assert_allclose(ours, _standing(theirs), atol=1e-9)


def test_cmu_walk_is_read_with_its_conventions(shared_data: Path) -> None:
    """The waist of CMU 02_01 travels 3.366 m, with unit, axes and rate as stated by the file."""
    capture = _read((shared_data / "motion" / "cmu_c3d" / "02_01.c3d").read_bytes())
    motion = _markers(capture)
    waist = motion.positions_m[:, [motion.names.index(f"{s}WT") for s in ("LF", "RF", "LB", "RB")]]
    middle = waist.mean(axis=1)
    assert float(np.linalg.norm(middle[-1] - middle[0])) == pytest.approx(3.366, abs=5e-4)
    conventions = capture.conventions
    assert [
        (c.value, c.origin) for c in (conventions.length, conventions.axes, conventions.rate)
    ] == [
        ("mm", "file"),
        ("z up, right-handed", "file"),
        ("120 Hz", "file"),
    ]
    assert "LFHD" in motion.names  # TakeoMonday:LFHD in the file


def test_duplicate_labels_are_replaced_by_descriptions(shared_data: Path) -> None:
    """In Gait.c3d, where both knee markers are called RKNE, descriptions become the names."""
    motion = _markers(_read((shared_data / "motion" / "c3d" / "Gait.c3d").read_bytes()))
    assert {"R.Knee", "R.Knee.Medial", "V.Sacral"} <= set(motion.names)
    assert len(set(motion.names)) == len(motion.names)


@pytest.mark.parametrize("processor", [INTEL, DEC, MIPS])
@pytest.mark.parametrize("real", [True, False])
@pytest.mark.parametrize("analogue", [0, 5])
def test_each_processor_and_number_type_gives_the_same_positions(
    processor: int, *, real: bool, analogue: int
) -> None:
    """Every processor and number type gives the same positions, with gaps as NaN."""
    places = _some_places()
    file = C3dFile(places, ("A", "B", "C"), processor, real, rate_hz=160.0, analogue=analogue)
    motion = _markers(_read(file.to_bytes()))
    assert (motion.names, motion.rate_hz) == (("A", "B", "C"), 160.0)
    tolerance_m = 1e-7 if real else 0.5e-3 * file.scale + 1e-9
    np.testing.assert_allclose(motion.positions_m, _standing(places), atol=tolerance_m)


def test_more_frames_than_sixteen_bits_can_count() -> None:
    """70,000 frames are read by the TRIAL fields though POINT:FRAMES can only state 4,464."""
    places = np.tile(_some_places(1, 2), (70_000, 1, 1))
    capture = _read(C3dFile(places, ("A", "B"), long=True).to_bytes())
    assert capture.motion.frame_count == 70_000
    assert any("differently" in note for note in capture.notes)


def test_more_markers_than_one_list_can_name() -> None:
    """Labels after the 255th are read from LABELS2, so the 300th marker has its name."""
    labels = tuple(f"M{number}" for number in range(300))
    motion = _markers(_read(C3dFile(_some_places(3, 300), labels).to_bytes()))
    assert motion.names == labels


def test_computed_channels_and_subjects_are_left_out() -> None:
    """Angles that Vicon lists among the points are left out, and so is a subject's prefix."""
    file = C3dFile(
        _some_places(4, 3), ("Ann:LKNE", "Ann:LKneeAngles", "Ann:RKNE"),
        lists={"ANGLES": ("Ann:LKneeAngles",)},
    )  # fmt: skip
    capture = _read(file.to_bytes())
    assert _markers(capture).names == ("LKNE", "RKNE")
    assert any("computed" in note for note in capture.notes)
    two = replace(file, labels=("Ann:LKNE", "Bob:LKNE", "Bob:RKNE"), lists={})
    assert _markers(_read(two.to_bytes())).names == ("Ann:LKNE", "Bob:LKNE", "Bob:RKNE")


@pytest.mark.parametrize(
    ("declared", "expected"),
    [("+Y", (1.0, 2.0, 3.0)), ("+Z", (1.0, 3.0, -2.0)), ("+X", (-2.0, 1.0, 3.0)),
     ("-Z", (1.0, -3.0, 2.0))],
)  # fmt: skip
def test_the_screen_parameter_gives_the_up_axis(declared: str, expected: tuple[float, ...]) -> None:
    """The axis that Y_SCREEN names points up, and becomes y without mirroring."""
    places = np.array([[[1000.0, 2000.0, 3000.0]]])
    file = C3dFile(places, ("A",), texts={"UNITS": "mm", "Y_SCREEN": declared})
    np.testing.assert_allclose(_markers(_read(file.to_bytes())).positions_m[0, 0], expected)


def test_the_users_choice_overrides_the_file() -> None:
    """A unit and an axis that the user chose override the file's and are marked as chosen."""
    file = C3dFile(np.array([[[1.0, 2.0, 3.0]]]), ("A",))
    capture = _read(file.to_bytes(), Reading(metres_per_unit=0.01, up="y"))
    np.testing.assert_allclose(_markers(capture).positions_m[0, 0], (0.01, 0.02, 0.03), rtol=1e-6)
    assert capture.conventions.axes.origin == capture.conventions.length.origin == "chosen"


def test_missing_unit_and_axis_are_guessed() -> None:
    """If a file states no unit and axis, millimetres and the standing body's axis are guessed."""
    rng = np.random.default_rng(2)
    places = rng.uniform(-1.0, 1.0, (20, 8, 3)) * (250.0, 150.0, 850.0)
    labels = tuple("ABCDEFGH")
    capture = _read(C3dFile(places, labels, texts={}).to_bytes())
    np.testing.assert_allclose(_markers(capture).positions_m, _standing(places), atol=1e-6)
    assert capture.conventions.axes.origin == capture.conventions.length.origin == "guessed"
    assert any("guessed" in note for note in capture.notes)


def test_a_truncated_file_is_rejected() -> None:
    """A header that claims more frames than the file has is rejected without allocating them."""
    whole = C3dFile(_some_places(50), ("A", "B", "C")).to_bytes()
    with pytest.raises(CaptureError, match="50 frames but contains 49"):
        _read(whole[:-8])
    huge = C3dFile(_some_places(1), ("A", "B", "C"), stated_frames=65_535).to_bytes()
    with pytest.raises(CaptureError, match="contains 1"):
        _read(huge)


@pytest.mark.parametrize(
    ("at", "value", "expected_message"),
    [
        (0, 200, "parameters at byte"),
        (1, 0, "no C3D"),
        (512 + 3, 12, "processor 12"),
        (2, 0, "0 markers"),
        (16, 99, "begin at byte"),
    ],
)
def test_a_damaged_header_is_rejected_with_the_reason(
    at: int, value: int, expected_message: str
) -> None:
    """Each damaged field of the header is named in the error."""
    data = bytearray(C3dFile(_some_places(), ("A", "B", "C")).to_bytes())
    data[at] = value
    if at == 2:
        data[3] = 0
    with pytest.raises(CaptureError, match=expected_message):
        _read(bytes(data))


def test_a_file_without_visible_markers_is_rejected() -> None:
    """A file in which no marker is ever seen is rejected."""
    file = C3dFile(np.full((3, 2, 3), np.nan), ("A", "B"))
    with pytest.raises(CaptureError, match="none of the 2 markers"):
        _read(file.to_bytes())


def test_limits_are_enforced_by_the_header() -> None:
    """Too many markers or values are rejected by the header alone."""
    data = C3dFile(_some_places(50), ("A", "B", "C")).to_bytes()
    with pytest.raises(CaptureError, match="1 to 2 are valid"):
        _read(data, limits=Limits(tracks=2))
    with pytest.raises(CaptureError, match="too many"):
        _read(data, limits=Limits(values=100))
    with pytest.raises(CaptureError, match="bytes"):
        _read(data, limits=Limits(bytes=100))
