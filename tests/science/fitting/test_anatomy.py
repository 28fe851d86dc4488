"""Tests that the fit notices by anatomy what no residual shows: mirrored, swapped and wrong."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.adapters.captures.reader import read_capture
from app.science.anatomy import (
    mirrored_bodies,
    mirrored_markers,
    turned_over_bodies,
    turned_over_markers,
)
from app.science.fitting import FitError, Fitted, fit_skeleton
from app.science.rig import BodyMotion, MarkerMotion
from app.science.rotations import geodesic_angle
from tests.science.fitting.synthetic_body import NAMES, bodies_on, markers_on, moving

_CAPTURES = (
    "cmu_c3d/02_01.c3d", "c3d/Gait.c3d", "trc/walk.trc",
    "vicon_tracker/HumanRobotHandover_0.csv", "vicon_tracker/ObjectInspection_0.csv",
)  # fmt: skip


def _bone(fitted: Fitted, name: str) -> float:
    rig = fitted.motion.rig
    return float(np.linalg.norm(rig.offsets_m[rig.index(name)]))


def _renamed(markers: MarkerMotion, names: dict[str, str]) -> MarkerMotion:
    return replace(markers, names=tuple(names.get(name, name) for name in markers.names))


def _swapped(markers: MarkerMotion, *pairs: tuple[str, str]) -> MarkerMotion:
    return _renamed(markers, {a: b for x, y in pairs for a, b in ((x, y), (y, x))})


def _moved(markers: MarkerMotion, name: str, towards: str, share: float) -> MarkerMotion:
    """Return the markers with one of them moved a share of the way towards another."""
    places = markers.positions_m.copy()
    one, other = markers.names.index(name), markers.names.index(towards)
    places[:, one] += share * (places[:, other] - places[:, one])
    return replace(markers, positions_m=places)


@pytest.mark.parametrize("seed", range(3))
def test_a_mirrored_marker_set_is_mirrored_back(seed: int) -> None:
    """Markers in left-handed axes give the same body as in right-handed ones, and it is said."""
    markers = markers_on(moving(seed))
    there, here = fit_skeleton(mirrored_markers(markers)), fit_skeleton(markers)
    assert here.notices == ()
    assert [(notice.rule, notice.action) for notice in there.notices] == [("mirrored", "mended")]
    assert there.notices[0].sentence in there.notes
    np.testing.assert_allclose(there.motion.rig.offsets_m, here.motion.rig.offsets_m, atol=1e-9)
    assert float(geodesic_angle(there.motion.rotations, here.motion.rotations).max()) < 1e-6


def test_mirrored_bodies_on_the_trunk_are_mirrored_back() -> None:
    """Rigid bodies on an upper body whose elbows bend forwards are mirrored back."""
    bodies = bodies_on(moving(1), 1)
    there, here = fit_skeleton(mirrored_bodies(bodies)), fit_skeleton(bodies)
    assert here.notices == ()
    assert [(notice.rule, notice.action) for notice in there.notices] == [("mirrored", "mended")]
    np.testing.assert_allclose(there.motion.rig.offsets_m, here.motion.rig.offsets_m, atol=1e-9)


@pytest.mark.parametrize("name", _CAPTURES)
def test_a_real_capture_upside_down_is_turned_over(shared_data: Path, name: str) -> None:
    """Each capture in a world whose y points down gives the same body as captured; it is said."""
    path = shared_data / "motion" / name
    motion = read_capture(path.read_bytes(), name=path.name).motion
    assert isinstance(motion, BodyMotion | MarkerMotion)
    over = (
        turned_over_bodies(motion)
        if isinstance(motion, BodyMotion)
        else turned_over_markers(motion)
    )
    there, here = fit_skeleton(over), fit_skeleton(motion)
    assert here.notices == ()
    assert [(notice.rule, notice.action) for notice in there.notices] == [("upright", "mended")]
    np.testing.assert_allclose(there.motion.rig.offsets_m, here.motion.rig.offsets_m, atol=1e-9)
    assert float(geodesic_angle(there.motion.rotations, here.motion.rotations).max()) < 1e-6


@pytest.mark.parametrize(
    ("pairs", "told"),
    [
        ([("LFWT", "LBWT"), ("RFWT", "RBWT")], "hip centres would lie above it"),
        ([("LFWT", "RFWT"), ("LBWT", "RBWT")], "the knees are swapped against the pelvis"),
        ([("LSHO", "RSHO")], "the shoulders are swapped against the pelvis"),
        (
            [("LANK", "RANK"), ("LHEE", "RHEE"), ("LTOE", "RTOE")],
            "the feet are swapped against the pelvis",
        ),
        ([("LTOE", "LHEE"), ("RTOE", "RHEE")], "The feet point backwards"),
        ([("LTOE", "LHEE")], "The left foot points backwards"),
        ([("RTOE", "RHEE")], "The right foot points backwards"),
    ],
)
def test_labels_that_contradict_each_other_are_refused(
    pairs: list[tuple[str, str]], told: str
) -> None:
    """Swapped front and back, sides or ends of feet are refused with value and remedy."""
    with pytest.raises(FitError, match=told) as refused:
        fit_skeleton(_swapped(markers_on(moving(2)), *pairs))
    for part in ("Found: ", "degrees", "expected: less than 90 degrees", "Exchange the labels"):
        assert part in str(refused.value)


@pytest.mark.parametrize("foot", ["L", "R"])
def test_one_foot_of_a_real_walk_with_heel_and_toes_exchanged_is_refused(
    shared_data: Path, foot: str
) -> None:
    """Each foot is judged by itself: one that points backwards is named with the remedy."""
    path = shared_data / "motion" / "cmu_c3d/02_01.c3d"
    motion = read_capture(path.read_bytes(), name=path.name).motion
    assert isinstance(motion, MarkerMotion)
    ends = {end: next(name for name in motion.names if name.endswith(foot + end))
            for end in ("HEE", "TOE")}  # fmt: skip
    side = {"L": "left", "R": "right"}[foot]
    with pytest.raises(FitError, match=f"The {side} foot points backwards") as refused:
        fit_skeleton(_swapped(motion, (ends["HEE"], ends["TOE"])))
    assert f"labels of heel and toes of the {side} foot" in str(refused.value)


def test_noise_is_refused_as_no_body() -> None:
    """Markers that are noise are refused because segments change their length, not by luck."""
    markers = markers_on(moving(2))
    noise = np.random.default_rng(7).normal(0.0, 0.5, markers.positions_m.shape)
    for places in (noise, markers.positions_m + noise):
        with pytest.raises(FitError, match="do not move like a body"):
            fit_skeleton(replace(markers, positions_m=places))


def test_sides_that_differ_by_ten_centimetres_get_the_length_that_fits() -> None:
    """A knee marker 10 cm too low makes one thigh longer; both get the length of the other."""
    markers = _moved(markers_on(moving(3)), "LKNE", "LANK", 0.10 / 0.41)
    fitted = fit_skeleton(markers)
    rules = [(notice.rule, notice.action) for notice in fitted.notices]
    assert ("sides", "mended") in rules
    for joint in ("LowerLeg", "Foot"):
        assert _bone(fitted, f"Left{joint}") == pytest.approx(_bone(fitted, f"Right{joint}"))
    assert _bone(fitted, "LeftLowerLeg") == pytest.approx(0.43, abs=0.02)
    assert any("differ by more than people's do" in note for note in fitted.notes)


def test_upper_arms_of_17_cm_get_the_length_of_the_proportions() -> None:
    """Elbow markers too high on both arms give upper arms of 17 cm; they become those of people."""
    share = 1.0 - 0.17 / 0.29
    short = markers_on(moving(4))
    for side in "LR":
        short = _moved(short, f"{side}ELB", f"{side}SHO", share)
    fitted = fit_skeleton(short)
    assert ("length", "mended") in [(notice.rule, notice.action) for notice in fitted.notices]
    assert 0.26 < _bone(fitted, "LeftLowerArm") < 0.36


def test_arms_of_17_cm_are_refused() -> None:
    """Arms of 17 cm from shoulder to wrist on an adult are refused with value and valid lengths."""
    short = markers_on(moving(4))
    for side in "LR":
        for name in ("ELB", "WRA", "WRB", "FIN"):
            short = _moved(short, f"{side}{name}", f"{side}SHO", 0.69)
    with pytest.raises(FitError, match="upper arm is no person's") as refused:
        fit_skeleton(short)
    assert "22 to 41 cm for a stature of 1.71 m" in str(refused.value)


def test_a_marker_set_without_toes_is_refused_by_name() -> None:
    """Without any marker on the toes no leg can be fitted; the error names what is missing."""
    markers = markers_on(moving(5))
    with pytest.raises(FitError, match="LTOE"):
        fit_skeleton(_renamed(markers, {"LTOE": "X1", "RTOE": "X2"}))


def test_markers_that_are_labelled_but_never_seen_are_named() -> None:
    """A foot whose labels exist but whose markers were never seen is told apart from none."""
    markers = markers_on(moving(5))
    places = markers.positions_m.copy()
    places[:, [markers.names.index(name) for name in ("LANK", "LTOE")]] = np.nan
    with pytest.raises(FitError, match="LANK, LTOE are labelled but were never seen"):
        fit_skeleton(replace(markers, positions_m=places))


@pytest.mark.parametrize("name", _CAPTURES)
def test_captured_people_are_not_changed(shared_data: Path, name: str) -> None:
    """No capture of a person is noticed, and every mirrored one is, with the same bones."""
    file = shared_data / "motion" / name
    motion = read_capture(file.read_bytes(), name=file.name).motion
    assert isinstance(motion, MarkerMotion | BodyMotion)
    fitted = fit_skeleton(motion)
    assert fitted.notices == ()
    if isinstance(motion, MarkerMotion):
        there = fit_skeleton(mirrored_markers(motion))
    else:
        there = fit_skeleton(mirrored_bodies(motion))
    assert [(notice.rule, notice.action) for notice in there.notices] == [("mirrored", "mended")]
    np.testing.assert_allclose(there.motion.rig.offsets_m, fitted.motion.rig.offsets_m, atol=1e-6)


def test_the_synthetic_person_is_a_person() -> None:
    """The person of these tests has no notices, whatever the movement."""
    assert len(NAMES) == 21
    for seed in range(8):
        assert fit_skeleton(markers_on(moving(seed))).notices == ()
