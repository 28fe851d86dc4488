"""Tests of how the fit handles markers that were not seen, and of what it rejects."""

import numpy as np
import pytest

from app.science.fitting import FitError, fit_skeleton
from app.science.fitting.resampling import bridged, longest_run
from app.science.rig import BodyMotion, MarkerMotion
from app.science.rotations import identity
from tests.science.fitting.synthetic_body import BODIES, bodies_on, markers_on, moving


def _hidden(markers: MarkerMotion, name: str, first: int, end: int) -> MarkerMotion:
    places = markers.positions_m.copy()
    places[first:end, markers.names.index(name)] = np.nan
    return MarkerMotion(markers.names, markers.rate_hz, places)


def test_a_short_gap_is_bridged_and_marked() -> None:
    """Ten frames without the left knee are kept, with that leg marked as not observed."""
    fitted = fit_skeleton(_hidden(markers_on(moving(0)), "LKNE", 20, 30))
    motion = fitted.motion
    assert motion.frame_count == 200
    leg, head = motion.rig.index("LeftLowerLeg"), motion.rig.index("Head")
    assert not motion.observed[20:30, leg].any()
    assert motion.observed[:20, leg].all()
    assert motion.observed[30:, leg].all()
    assert motion.observed[:, head].all()
    assert any("bridged" in note for note in fitted.notes)


def test_a_long_gap_in_a_leg_trims_to_the_longest_whole_stretch() -> None:
    """If a knee is unseen for 0.6 s, the longer part is kept, with a note of where it begins."""
    fitted = fit_skeleton(_hidden(markers_on(moving(0)), "LKNE", 60, 120))
    assert (fitted.first_frame, fitted.motion.frame_count) == (120, 80)
    assert any("0.80 s from 1.20 s on" in note for note in fitted.notes)


def test_a_long_gap_in_an_arm_leaves_the_arm_out() -> None:
    """An arm whose elbow is unseen for 0.6 s is left out, so that all frames are kept."""
    fitted = fit_skeleton(_hidden(markers_on(moving(0)), "LELB", 60, 120))
    assert fitted.motion.frame_count == 200
    assert "LeftUpperArm" in fitted.unfitted
    assert "RightUpperArm" not in fitted.unfitted
    assert any("left arm is left out" in note for note in fitted.notes)


def test_a_leg_never_seen_whole_is_rejected() -> None:
    """If no half second shows both legs, the error names the joint that is missing most often."""
    markers = markers_on(moving(0))
    for start in range(0, 200, 40):
        markers = _hidden(markers, "RANK", start, start + 39)
    with pytest.raises(FitError, match=r"Right\w+ is missing most"):
        fit_skeleton(_hidden(markers, "RANK", 0, 120))


def test_markers_of_one_leg_are_no_body() -> None:
    """Markers of a single leg raise an error that lists the markers that a body needs."""
    names = ("Foot_Marker1", "Foot_Marker2", "Leg_Marker1")
    with pytest.raises(FitError, match=r"Foot_Marker1.*pelvis needs LASI, RASI and SACR"):
        fit_skeleton(MarkerMotion(names, 100.0, np.zeros((10, 3, 3))))


def test_a_headset_and_two_controllers_are_no_body() -> None:
    """Three tracked objects raise an error that states the reason and what would suffice."""
    bodies = BodyMotion(
        ("Head", "LeftHand", "RightHand"),
        np.arange(5) / 90.0, np.zeros((5, 3, 3)), identity(5, 3),
    )  # fmt: skip
    with pytest.raises(FitError, match=r"Too few tracked bodies.*LeftHand.*hip, collar"):
        fit_skeleton(bodies)


def test_missing_bodies_are_named() -> None:
    """Without a rigid body on the right elbow the error names it as missing."""
    bodies = bodies_on(moving(0), 0)
    remaining = [place for place, name in enumerate(BODIES) if name != "right_elbow"]
    few = BodyMotion(
        tuple(BODIES[place] for place in remaining), bodies.times_s,
        bodies.positions_m[:, remaining], bodies.rotations[:, remaining],
    )  # fmt: skip
    with pytest.raises(FitError, match="right elbow missing"):
        fit_skeleton(few)


def test_times_that_do_not_increase_are_rejected() -> None:
    """Samples whose times do not increase are rejected, since they have no rate."""
    bodies = bodies_on(moving(0), 0)
    still = BodyMotion(
        bodies.names, np.zeros_like(bodies.times_s), bodies.positions_m, bodies.rotations
    )
    with pytest.raises(FitError, match="do not increase"):
        fit_skeleton(still)


@pytest.mark.parametrize("seed", range(12))
def test_any_gaps_and_places_give_a_skeleton_or_a_reason(seed: int) -> None:
    """Random gaps and marker positions always give a skeleton or a `FitError`."""
    rng = np.random.default_rng(seed)
    markers = markers_on(moving(seed % 3))
    places = markers.positions_m.copy()
    places[rng.random(places.shape[:2]) < rng.choice([0.02, 0.3, 0.9])] = np.nan
    if seed % 3 == 1:
        places[:, rng.integers(places.shape[1], size=5)] = 0.0
    if seed % 4 == 2:
        places[rng.integers(200, size=40), rng.integers(places.shape[1])] = 9e4
    try:
        fitted = fit_skeleton(MarkerMotion(markers.names, markers.rate_hz, places))
    except FitError:
        return
    assert np.isfinite(fitted.motion.rotations).all()
    assert np.isfinite(fitted.motion.rig.offsets_m).all()


def test_short_gaps_are_interpolated_linearly() -> None:
    """Short gaps are interpolated linearly; long and open gaps stay empty."""
    values = np.arange(200.0)[:, None] * (1.0, 2.0)
    expected = values.copy()
    values[10:20] = np.nan
    values[50:120] = np.nan
    values[:3] = np.nan
    filled, seen = bridged(values, 100.0)
    np.testing.assert_allclose(filled[3:50], expected[3:50])
    assert np.isnan(filled[50:120]).all()
    assert np.isnan(filled[:3]).all()
    assert int((~seen).sum()) == 83


def test_the_longest_run_is_found() -> None:
    """The longest run of true values is found; without any it is empty."""
    assert longest_run(np.array([1, 0, 1, 1, 0], np.bool_)) == (2, 4)
    assert longest_run(np.zeros(3, np.bool_)) == (0, 0)
