"""What the fit does where markers were not seen, and what it refuses."""

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


def test_a_short_gap_is_bridged_and_told() -> None:
    """Ten frames without the left knee keep their frames, marked as not observed in that leg."""
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
    """A knee unseen for 0.6 s leaves the longer side, and says from when on."""
    fitted = fit_skeleton(_hidden(markers_on(moving(0)), "LKNE", 60, 120))
    assert (fitted.first_frame, fitted.motion.frame_count) == (120, 80)
    assert any("0.80 s from 1.20 s on" in note for note in fitted.notes)


def test_a_long_gap_in_an_arm_costs_the_arm() -> None:
    """An elbow unseen for 0.6 s would cost most of the frames: the arm is left out instead."""
    fitted = fit_skeleton(_hidden(markers_on(moving(0)), "LELB", 60, 120))
    assert fitted.motion.frame_count == 200
    assert "LeftUpperArm" in fitted.unfitted
    assert "RightUpperArm" not in fitted.unfitted
    assert any("left arm is left out" in note for note in fitted.notes)


def test_a_leg_never_seen_whole_is_refused() -> None:
    """Where no half second holds both legs, the joint that is missing most is named."""
    markers = markers_on(moving(0))
    for start in range(0, 200, 40):
        markers = _hidden(markers, "RANK", start, start + 39)
    with pytest.raises(FitError, match=r"Right\w+ is missing most"):
        fit_skeleton(_hidden(markers, "RANK", 0, 120))


def test_markers_of_one_leg_are_no_body() -> None:
    """Clusters on a foot and a shank are refused with what a body takes."""
    names = ("Foot_Marker1", "Foot_Marker2", "Leg_Marker1")
    with pytest.raises(FitError, match=r"Foot_Marker1.*pelvis needs LASI, RASI and SACR"):
        fit_skeleton(MarkerMotion(names, 100.0, np.zeros((10, 3, 3))))


def test_a_headset_and_two_controllers_are_no_body() -> None:
    """Three tracked things are refused with the reason and with what would do."""
    bodies = BodyMotion(
        ("Head", "LeftHand", "RightHand"),
        np.arange(5) / 90.0, np.zeros((5, 3, 3)), identity(5, 3),
    )  # fmt: skip
    with pytest.raises(FitError, match=r"Too few tracked bodies.*LeftHand.*hip, collar"):
        fit_skeleton(bodies)


def test_missing_bodies_are_named() -> None:
    """Without the right elbow there is no arm to fit, and the message says which body it is."""
    bodies = bodies_on(moving(0), 0)
    kept = [place for place, name in enumerate(BODIES) if name != "right_elbow"]
    few = BodyMotion(
        tuple(BODIES[place] for place in kept), bodies.times_s,
        bodies.positions_m[:, kept], bodies.rotations[:, kept],
    )  # fmt: skip
    with pytest.raises(FitError, match="right elbow missing"):
        fit_skeleton(few)


def test_times_that_stand_still_are_refused() -> None:
    """Samples without time between them have no rate."""
    bodies = bodies_on(moving(0), 0)
    still = BodyMotion(
        bodies.names, np.zeros_like(bodies.times_s), bodies.positions_m, bodies.rotations
    )
    with pytest.raises(FitError, match="do not increase"):
        fit_skeleton(still)


@pytest.mark.parametrize("seed", range(12))
def test_any_gaps_and_places_give_a_skeleton_or_a_reason(seed: int) -> None:
    """Random losses, points on one another and far away never end in anything but these two."""
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


def test_a_bridge_is_a_straight_line_between_what_was_seen() -> None:
    """Values inside short gaps are interpolated, long and open gaps stay empty."""
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
    """Of several runs the longest is returned, and none for none."""
    assert longest_run(np.array([1, 0, 1, 1, 0], np.bool_)) == (2, 4)
    assert longest_run(np.zeros(3, np.bool_)) == (0, 0)
