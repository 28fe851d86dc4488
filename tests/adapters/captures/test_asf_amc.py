"""Tests of reading Acclaim's ASF and AMC files."""

from pathlib import Path

import numpy as np
import pytest

from app.adapters.captures import Capture, CaptureError, Limits, Reading
from app.adapters.captures.asf_amc import read_asf_amc
from app.adapters.captures.c3d import read_c3d
from app.science.rig import MarkerMotion, RigMotion
from tests.adapters.captures.marker_seeds import AMC as _AMC
from tests.adapters.captures.marker_seeds import ASF as _ASF

_UNIT_M = 0.0254 / 0.45


def _read(
    amc: str = _AMC, asf: str = _ASF, *, limits: Limits | None = None, up: bool = False
) -> Capture:
    reading = Reading(companions={"small.asf": asf.encode()}, up="z" if up else None)
    return read_asf_amc(
        amc.encode(), name="small_01.amc", reading=reading, limits=limits or Limits()
    )


def _motion(capture: Capture) -> RigMotion:
    assert isinstance(capture.motion, RigMotion)
    return capture.motion


def _cmu(shared_data: Path, clip: str) -> RigMotion:
    folder = shared_data / "motion" / "cmu_asfamc"
    reading = Reading(companions={"02.asf": (folder / "02.asf").read_bytes()})
    name = f"{clip}.amc"
    return _motion(
        read_asf_amc((folder / name).read_bytes(), name=name, reading=reading, limits=Limits())
    )


def test_a_bone_turns_about_its_own_axis() -> None:
    """A bone turns about its own axis: C M C^-1.

    With the axis turned 90 degrees about z, rx turns the thigh about the world's y.
    """
    motion = _motion(_read())
    positions, _ = motion.world()
    assert motion.rig.names == ("root", "thigh", "shin")
    np.testing.assert_allclose(positions[0, 2], np.array((1.0, 2.0 - 8.0, 3.0)) * _UNIT_M)
    np.testing.assert_allclose(motion.rotations[1, 1], (0.5**0.5, 0.0, 0.5**0.5, 0.0), atol=1e-12)
    ((joint, end),) = motion.rig.ends
    assert joint == 2
    assert end == pytest.approx((0.0, -7.0 * _UNIT_M, 0.0))


def test_fixed_axes_turn_in_the_order_of_their_letters() -> None:
    """Axis order XYZ turns about x first, then the world's y, then the world's z: Rz Ry Rx."""
    amc = _AMC.replace("root 1 2 3 0 90 0", "root 0 0 0 90 90 0")
    _, world = _motion(_read(amc)).world()
    # First x by 90, then y by 90, carries z to -y and leaves it there.
    w, x, y, z = world[1, 0]
    carried = np.array((2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)))
    np.testing.assert_allclose(carried, (0.0, -1.0, 0.0), atol=1e-12)


def test_cmu_walk_agrees_with_its_markers_and_its_bvh(shared_data: Path) -> None:
    """The CMU walk's root travels 3.362 m, its waist markers 3.366 m; knees agree within 10 cm."""
    motion = _cmu(shared_data, "02_01")
    root = motion.root_positions_m
    assert float(np.linalg.norm(root[-1] - root[0])) == pytest.approx(3.362, abs=5e-4)
    markers = read_c3d(
        (shared_data / "motion" / "cmu_c3d" / "02_01.c3d").read_bytes(),
        name="02_01.c3d", reading=Reading(up="y"), limits=Limits(),
    ).motion  # fmt: skip
    assert isinstance(markers, MarkerMotion)
    # The C3D's room has z up and the AMC's y up: x, y, z of the one are z, x, y of the other.
    positions, _ = motion.world()
    for bone, marker in (("ltibia", "LKNE"), ("rtibia", "RKNE"), ("lfoot", "LANK")):
        seen = markers.positions_m[:, markers.names.index(marker)][:, [1, 2, 0]]
        apart = np.linalg.norm(positions[:, motion.rig.index(bone)] - seen, axis=-1)
        assert float(apart.max()) < 0.1


def test_the_shared_bvh_of_that_walk_is_scaled(shared_data: Path) -> None:
    """The root of 02_01.bvh moves 1.06312 times as far as that of the AMC."""
    from app.adapters.bvh import read_bvh

    root = _cmu(shared_data, "02_01").root_positions_m
    bvh = read_bvh(shared_data / "motion" / "cmu_bvh" / "02_01.bvh", metres_per_unit=0.0254 / 0.45)
    np.testing.assert_allclose(bvh.root_positions_m, 1.06312 * root, atol=1e-5)


def test_the_skeleton_has_human_lengths_and_reports_its_unit(shared_data: Path) -> None:
    """Thigh is 42.9 cm and shin 41.1 cm; the file's length of 0.45 gives a unit of 0.0564444 m."""
    motion = _cmu(shared_data, "02_06")
    lengths = np.linalg.norm(motion.rig.offsets_m, axis=1)
    assert motion.frame_count == 2235
    assert float(lengths[motion.rig.index("ltibia")]) == pytest.approx(0.4286, abs=1e-3)
    assert float(lengths[motion.rig.index("lfoot")]) == pytest.approx(0.4113, abs=1e-3)
    assert _read().conventions.length.value == "0.0564444 m"
    assert _read().conventions.rate.origin == "guessed"


def test_rows_left_out_are_carried_over() -> None:
    """A bone without a row keeps its rotation and is marked as not observed."""
    motion = _motion(_read(_AMC.replace("shin 30\n", "")))
    np.testing.assert_array_equal(motion.rotations[1, 2], motion.rotations[0, 2])
    assert motion.observed.tolist() == [[True, True, True], [True, True, False]]


def test_radians_and_another_axis_up_are_understood() -> None:
    """The AMC's :RADIANS overrides the ASF's degrees; a chosen up axis turns the world."""
    radians = _AMC.replace(":DEGREES", ":RADIANS").replace("0 90 0", f"0 {np.pi / 2} 0")
    radians = radians.replace("thigh 90 0", f"thigh {np.pi / 2} 0")
    np.testing.assert_allclose(
        _motion(_read(radians)).rotations[1, :2], _motion(_read()).rotations[1, :2], atol=1e-12
    )
    turned = _motion(_read(up=True)).root_positions_m[0]
    np.testing.assert_allclose(turned, np.array((1.0, 3.0, -2.0)) * _UNIT_M, atol=1e-12)


def test_the_missing_file_is_named() -> None:
    """The error about a single file names the missing one: the ASF of an AMC, or the AMC."""
    with pytest.raises(CaptureError, match=r"give\s+02\.asf with it"):
        read_asf_amc(_AMC.encode(), name="02_01.amc", reading=Reading(), limits=Limits())
    with pytest.raises(CaptureError, match=r"skeleton without movement.*02_01\.amc"):
        read_asf_amc(_ASF.encode(), name="02.asf", reading=Reading(), limits=Limits())
    two = Reading(companions={"a.asf": b"", "b.asf": b""})
    with pytest.raises(CaptureError, match="2 skeletons"):
        read_asf_amc(_AMC.encode(), name="02_01.amc", reading=two, limits=Limits())


@pytest.mark.parametrize(
    ("old", "new", "line", "expected_message"),
    [
        ("thigh 90 0", "tail 90 0", 10, "'tail' does not move"),
        ("thigh 90 0", "thigh 90", 10, "1 values"),
        ("thigh 90 0", "thigh 90 nan", 10, "out of range"),
        ("thigh 90 0", "thigh 90 x", 10, "'x'"),
        ("\n2\n", "\n3\n", 8, "missing or repeated"),
        ("\n1\n", "\n", 4, "before the first frame"),
    ],
)
def test_errors_in_an_amc_are_reported_with_their_line(
    old: str, new: str, line: int, expected_message: str
) -> None:
    """Each error in an AMC is reported with its line."""
    with pytest.raises(CaptureError, match=expected_message) as caught:
        _read(_AMC.replace(old, new, 1))
    assert caught.value.line == line


@pytest.mark.parametrize(
    ("old", "new", "line", "expected_message"),
    [
        ("dof rx rz", "dof rx tz", 22, "shift or stretch"),
        ("length 8", "length much", 20, "'much'"),
        ("axis 0 0 90 XYZ", "axis 0 0 90 XYY", 21, "axis order"),
        ("name shin", "name thigh", 33, "a name of its own"),
        ("thigh shin\n", "thigh shin foot\n", 37, "no bone 'foot'"),
        ("thigh shin\n", "thigh thigh\n", 37, "two parents"),
        ("root thigh\n", "shin thigh\n", 0, "circle"),
        ("    thigh shin\n", "", 0, "no place"),
        ("order TX TY TZ", "order TX TY", 11, "order"),
        ("length 0.45", "length 0", 6, "0.001 to 1000"),
    ],
)
def test_errors_in_an_asf_are_reported_with_their_line(
    old: str, new: str, line: int, expected_message: str
) -> None:
    """Each error in an ASF is reported with its file and line."""
    assert old in _ASF
    with pytest.raises(CaptureError, match=f"small.asf: .*{expected_message}") as caught:
        _read(asf=_ASF.replace(old, new, 1))
    assert caught.value.line == line


def test_limits_are_enforced() -> None:
    """Too many bones or values in an ASF or AMC are rejected."""
    with pytest.raises(CaptureError, match="more than 1 bones"):
        _read(limits=Limits(tracks=1))
    with pytest.raises(CaptureError, match="2 frames of 12 values are too many"):
        _read(limits=Limits(values=20))
