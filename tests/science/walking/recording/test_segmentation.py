"""Tests that tracks are cut into walks where the person stands still."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d

from app.science.rotations import FloatArray
from app.science.walking.recording.segmentation import SegmentationRules, smoothed, walks_of
from app.science.walking.records.model import Track, WalkingError

RATE_HZ = 120.0


def _walked(*parts: tuple[float, float]) -> Track:
    """Return a minimum-jerk track from parts (seconds, metres ahead); 0 m means standing."""
    ahead, at = [np.zeros(1)], 0.0
    for seconds, metres in parts:
        share = np.arange(1, round(seconds * RATE_HZ) + 1) / round(seconds * RATE_HZ)
        ahead.append(at + metres * (10.0 * share**3 - 15.0 * share**4 + 6.0 * share**5))
        at += metres
    places = np.concatenate(ahead)
    xy_m = np.stack([np.zeros_like(places), places], axis=-1)
    return Track(np.arange(len(places)) / RATE_HZ, xy_m, "7", "made", "synthetic", 1.8)


def test_there_and_back_are_two_walks() -> None:
    """Walking 3 m there and back with 5 s of standing between gives two walks, as in the paper."""
    walks = walks_of(_walked((2.0, 0.0), (4.0, 3.0), (5.0, 0.0), (4.0, -3.0), (2.0, 0.0)))
    assert [round(walk.length_m, 1) for walk in walks] == [3.0, 3.0]
    for walk in walks:
        assert walk.begins_still
        assert walk.ends_still
        assert 3.2 < walk.duration_s < 4.0
        assert (walk.subject, walk.kind, walk.stature_m) == ("7", "synthetic", 1.8)
    assert walks[0].goal_m == pytest.approx(walks[1].start_m, abs=0.05)


def test_a_short_pause_belongs_to_the_walk() -> None:
    """A pause of about .8 s below .1 m/s is part of the walk unless the rules are shorter."""
    assert len(walks_of(_walked((1.0, 0.0), (3.0, 2.0), (0.2, 0.0), (3.0, 2.0), (1.0, 0.0)))) == 2
    rules = SegmentationRules(still_s=1.5)
    walks = walks_of(_walked((2.0, 0.0), (3.0, 2.0), (0.2, 0.0), (3.0, 2.0), (2.0, 0.0)), rules)
    assert [round(walk.length_m, 1) for walk in walks] == [4.0]


def test_a_walk_cut_by_the_recording_is_marked() -> None:
    """A walk that the recording cuts off is marked as not beginning or not ending at rest."""
    track = _walked((4.0, 4.0))
    middle = slice(120, 360)
    cut = Track(track.times_s[middle], track.xy_m[middle], "7", "made")
    (walk,) = walks_of(cut)
    assert not walk.begins_still
    assert not walk.ends_still
    assert walk.speeds_m_s[0] > 0.5


def test_standing_is_no_walk_and_neither_is_a_step() -> None:
    """A track of a standing person, or of a single step, has no walk."""
    assert walks_of(_walked((3.0, 0.0))) == []
    assert walks_of(_walked((1.0, 0.0), (0.8, 0.2), (1.0, 0.0))) == []


def test_places_are_smoothed_as_in_the_paper() -> None:
    """Positions are smoothed with sigma = 2 samples at 120 Hz, the same time at 60 Hz."""
    noise: FloatArray = np.random.default_rng(3).normal(size=(50, 2))
    for rate_hz, sigma in ((120.0, 2.0), (60.0, 1.0)):
        expected = gaussian_filter1d(noise, sigma, axis=0)
        assert smoothed(noise, rate_hz)[8:-8] == pytest.approx(expected[8:-8])


def test_smoothing_keeps_place_and_speed_at_the_ends() -> None:
    """Smoothing a steady walk keeps its position and speed in the first and the last frame."""
    steady = np.stack([np.zeros(40), np.arange(40) * 0.01], axis=-1)
    assert smoothed(steady, 120.0) == pytest.approx(steady, abs=1e-12)


def test_invalid_rules_are_rejected() -> None:
    """A negative threshold is rejected by name."""
    with pytest.raises(WalkingError, match="still_m_s"):
        SegmentationRules(still_m_s=-0.1)


def test_a_walk_has_the_numbers_that_stay_the_same_during_it() -> None:
    """A load that is changed while the person stands is a number of each walk; a gaze is not."""
    track = _walked((2.0, 0.0), (4.0, 3.0), (5.0, 0.0), (4.0, -3.0), (2.0, 0.0))
    half = track.times_s < 8.0
    load_kg = np.where(half, 8.0, 0.0)
    load_kg[track.times_s < 4.0] = np.nan
    gaze = np.where((track.times_s > 4.0) & half, 1.0, 0.0)
    known = np.full(len(half), np.nan)
    there, back = walks_of(
        replace(track, scene="hall", others={"load_kg": load_kg, "gaze": gaze, "mood": known})
    )
    assert (there.others, there.changing) == ({"load_kg": 8.0}, {"gaze": (0.0, 1.0)})
    assert (back.others, back.changing) == ({"load_kg": 0.0, "gaze": 0.0}, {})
    assert there.scene == back.scene == "hall"
    with pytest.raises(WalkingError, match=r"has load_kg of shape \(2,\): give"):
        replace(track, others={"load_kg": np.zeros(2)})
