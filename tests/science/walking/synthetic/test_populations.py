"""Tests that synthetic walkers have the properties that their populations describe."""

from dataclasses import replace

import numpy as np
import pytest

from app.science.walking.recording.segmentation import walks_of
from app.science.walking.records.model import WalkingError
from app.science.walking.scene.laboratory import pole_scene, straight_scene
from app.science.walking.synthetic.populations import POPULATIONS, person_of, walk_along
from app.science.walking.synthetic.synthetic_walks import Sample, straight_path, synthetic_walks


def test_there_are_five_populations_or_more_and_each_says_how_it_differs() -> None:
    """There are at least five populations with names and descriptions of their own."""
    assert len(POPULATIONS) >= 5
    assert len({one.name for one in POPULATIONS}) == len(POPULATIONS)
    assert len({one.about for one in POPULATIONS}) == len(POPULATIONS)


def test_people_walk_short_ways_slower() -> None:
    """Peak speed grows with distance d by 1 - exp(-d / b), within sway and variation."""
    peaks = []
    for length in (0.5, 1.0, 2.0, 4.0):
        speeds = []
        for number in range(12):
            rng = np.random.default_rng((7, number))
            person = person_of(POPULATIONS[0], number, rng)
            walk = walks_of(walk_along(person, straight_path(length), rng))[0]
            assert walk.begins_still
            assert walk.ends_still
            speeds.append(float(walk.speeds_m_s.max()) / person.speed_m_s)
        peaks.append(float(np.mean(speeds)))
    expected = 1.0 - np.exp(-np.array([0.5, 1.0, 2.0, 4.0]) / POPULATIONS[0].reach_m)
    assert np.array(peaks) == pytest.approx(expected, rel=0.12)


def test_turns_cost_time() -> None:
    """People without the one-third power law of curvature are faster round a pole."""
    scene = [pole_scene(180.0, 3.0)]
    slowed = replace(POPULATIONS[2], turn_exponent=1.0 / 3.0)
    times = [
        [entry.walk.duration_s for entry in synthetic_walks(one, scene, Sample(4))]
        for one in (slowed, replace(slowed, turn_exponent=0.0))
    ]
    assert (np.array(times[0]) > 1.02 * np.array(times[1])).all()


def test_people_differ_from_each_other_and_from_walk_to_walk() -> None:
    """Walks vary within people and more between people, and people sway."""
    entries = list(synthetic_walks(POPULATIONS[2], [straight_scene(4.0)], Sample(8, 3)))
    times = np.array([entry.walk.duration_s for entry in entries]).reshape(8, 3)
    assert 0.0 < times.std(axis=1).mean() < times.mean(axis=1).std()
    sideways = [np.ptp(entry.walk.xy_m[:, 0]) for entry in entries]
    assert 0.01 < np.mean(sideways) < 0.25


def test_the_same_seed_makes_the_same_people() -> None:
    """The same seed gives the same people, another seed others."""
    scene = [straight_scene(2.0)]
    one, same, other = (
        [e.walk.duration_s for e in synthetic_walks(POPULATIONS[0], scene, Sample(3, 1, seed))]
        for seed in (1, 1, 2)
    )
    assert one == same
    assert one != other


def test_a_sample_needs_people_and_paths() -> None:
    """A sample without people or without paths is rejected."""
    with pytest.raises(WalkingError, match="people"):
        list(synthetic_walks(POPULATIONS[0], [straight_scene(1.0)], Sample(0)))
